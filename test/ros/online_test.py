#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 beautymap contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The node and the nodelet as a user runs them: a real roscore, real processes, `rosbag play --clock`."""
import contextlib
import copy
import math
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy
import rosbag
import rosgraph
import roslib.packages
import rospy
import rostest
import yaml
from beautymap.msg import ScanReport
from beautymap.srv import LoadMap, SaveMap
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, TransformStamped
from nav_msgs.msg import OccupancyGrid, Path
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import PACKAGE, SHARED, executable, read_pcd

SCANS = 40
NODE = "/beautymap"


def wait_for(condition, what, timeout=30.0):
    end = time.time() + timeout
    while time.time() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.05)
    raise AssertionError(f"not within {timeout} s: {what() if callable(what) else what}")


def labels_of(folder_or_stem):
    """(points sorted by what identifies them, whether each was removed)"""
    stem = str(folder_or_stem)
    names = (stem + ".pcd", stem + "_dynamic.pcd")
    if os.path.isdir(stem):
        names = (stem + "/cleaned.pcd", stem + "/dynamic.pcd")
    points = [read_pcd(name)[1] for name in names]
    removed = numpy.repeat([False, True], [len(p) for p in points])
    points = numpy.concatenate(points)
    # By x, then y: one integer, as several keys take a minute for a whole drive.
    bits = [numpy.ascontiguousarray(points[name]).view("<i4").astype("i8") for name in ("x", "y")]
    x, y = (numpy.where(b < 0, -(b & 0x7fffffff), b) for b in bits)
    order = numpy.argsort((x << 32) + y, kind="stable")
    return points[order], removed[order]


def agreement(ours, theirs):
    """The share of points with the same label in two maps that hold the same points."""
    (a, removed_a), (b, removed_b) = labels_of(ours), labels_of(theirs)
    assert len(a) == len(b), f"{len(a)} points against {len(b)}"
    for name in ("x", "y", "z"):
        assert numpy.abs(a[name] - b[name]).max() < 1e-3
    return numpy.mean(removed_a == removed_b)


def cloud_size(cloud):
    return cloud.width * cloud.height


class Node:
    """A running node, and what it published."""

    def __init__(self, parameters, nodelet=False, launch=None, prepare=None):
        self.reports, self.maps, self.removed, self.dynamic, self.static = [], [], [], [], []
        self.diagnostics, self.matrices = [], []
        self.log = tempfile.NamedTemporaryFile(mode="w+", suffix=".log")
        if rospy.has_param(NODE):
            rospy.delete_param(NODE)
        for name, value in {"publish_period": 0.5, **parameters}.items():
            rospy.set_param(f"{NODE}/{name}", value)
        command = [executable("beautymap_node"), "__name:=beautymap"]
        if nodelet:
            command = [*roslib.packages.find_node("nodelet", "nodelet")[:1], "standalone",
                       "beautymap/BeautyMapNodelet", "__name:=beautymap"]
        if launch:
            command = ["roslaunch", *launch]
        self.subscribers = [
            rospy.Subscriber(NODE + topic, kind, into.append, queue_size=1000)
            for topic, kind, into in (
                ("/scan_report", ScanReport, self.reports),
                ("/cleaned_map", PointCloud2, self.maps),
                ("/removed_points", PointCloud2, self.removed),
                ("/dynamic_points", PointCloud2, self.dynamic),
                ("/static_points", PointCloud2, self.static),
                ("/matrix", OccupancyGrid, self.matrices))]
        self.subscribers.append(
            rospy.Subscriber("/diagnostics", DiagnosticArray, self.diagnostics.append))
        self.process = subprocess.Popen(command, stdout=self.log, stderr=subprocess.STDOUT,
                                        start_new_session=True, preexec_fn=prepare,
                                        restore_signals=prepare is None,
                                        env={**os.environ, "ROSCONSOLE_STDOUT_LINE_BUFFERED": "1"})

    def wait_until_connected(self):
        wait_for(lambda: self.subscribers[0].get_num_connections() > 0 and
                 self.subscribers[3].get_num_connections() > 0 and
                 self.subscribers[4].get_num_connections() > 0,
                 lambda: "the node: " + self.output())

    def output(self):
        return pathlib.Path(self.log.name).read_text()

    def wait_for_scans(self, count, timeout=180.0):
        wait_for(lambda: self.reports and self.reports[-1].scans >= count,
                 lambda: f"{count} scans; {len(self.reports)} reports, the last: "
                 f"{self.reports[-1:]}, {self.output()[-2000:]}", timeout)
        return self.reports[-1]

    def call(self, service, kind, **request):
        rospy.wait_for_service(f"{NODE}/{service}", timeout=20)
        return rospy.ServiceProxy(f"{NODE}/{service}", kind)(**request)

    def stop(self):
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGINT)
            try:
                self.process.wait(timeout=30)
            except subprocess.TimeoutExpired:
                os.killpg(self.process.pid, signal.SIGKILL)
                self.process.wait()
        for subscriber in self.subscribers:
            subscriber.unregister()
        return self.process.returncode


@contextlib.contextmanager
def running(parameters=None, nodelet=False, launch=None, prepare=None):
    node = Node(parameters or {}, nodelet, launch, prepare)
    try:
        node.wait_until_connected()
        yield node
    finally:
        node.stop()
        Player.stop()
        node.log.close()


class Player:
    """`rosbag play`, which on a busy machine must lose nothing: it begins when the node listens to
    the bag's clouds (the last that it subscribes to) and its messages have subscribers, and lives
    on at the end, as what a subscriber has not read yet goes with it."""

    process = None

    @classmethod
    def play(cls, bag, rate=2.0, duration=math.inf):
        """Returns when all is published."""
        cls.stop()
        with rosbag.Bag(str(bag)) as messages:
            end = min(messages.get_end_time(), messages.get_start_time() + duration)
            topics = messages.get_type_and_topic_info().topics
        clouds = {name for name, of in topics.items() if of.msg_type == "sensor_msgs/PointCloud2"}
        wait_for(lambda: clouds <= cls.heard_by_node(), f"the node listens to {clouds}")
        heard = cls.heard_by_node() & set(topics)
        clock = []
        subscriber = rospy.Subscriber("/clock", Clock, lambda now: clock.append(now.clock.to_sec()))
        cls.process = subprocess.Popen(
            ["rosbag", "play", "--clock", "-q", "-k", "--wait-for-subscribers", "-r", str(rate),
             *(["-u", str(duration)] if duration < math.inf else []), f"--bags={bag}",
             "--topics", *heard], stdout=subprocess.DEVNULL)
        wait_for(lambda: cls.process.poll() is not None or clock and clock[-1] > end - 0.1,
                 lambda: f"the end of {bag}, at {end}: {clock[-1:]}, {heard}", timeout=300)
        assert cls.process.poll() is None, f"rosbag play ended by itself: {bag}"
        subscriber.unregister()

    @staticmethod
    def heard_by_node():
        _, subscribers, _ = rosgraph.Master("/online_test").getSystemState()
        return {topic for topic, nodes in subscribers if NODE in nodes}

    @classmethod
    def stop(cls):
        if cls.process:
            cls.process.terminate()
            cls.process.wait()
            cls.process = None


play = Player.play


class Online(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("online_test", anonymous=True, disable_signals=True)
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="beautymap-online-"))
        cls.bag = cls.folder / "street.bag"
        cls.run_tool("simulate", "--scene", "street", "--sensor", "vlp16", "--scans", SCANS,
                     "--seed", 2, "--output", cls.bag)
        cls.offline = cls.folder / "offline"
        cls.run_tool("replay", cls.bag, "--output", cls.offline)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @staticmethod
    def run_tool(name, *arguments):
        done = subprocess.run([executable(f"beautymap_{name}"), *map(str, arguments)],
                              capture_output=True, text=True, timeout=300, check=False)
        assert done.returncode == 0, done.stderr

    def parameters(self, **more):
        return {"cloud_topics": ["/cloud"], "output_folder": str(self.folder / "out"),
                "queue_size": 1000, "online": {"map_voxel": 0.0}, **more}

    def rewrite(self, name, change, bag=None):
        """A bag with every message of one (the simulated) as change(topic, message, t) gives it."""
        path = self.folder / name
        with rosbag.Bag(str(bag or self.bag)) as source, rosbag.Bag(str(path), "w") as target:
            for topic, message, t in source.read_messages():
                for new_topic, new_message, new_t in change(topic, message, t):
                    target.write(new_topic, new_message, new_t)
        return path

    def check_map(self, node, at_least=0.99, folder=None):
        """The finished map is that of the replay."""
        saved = node.call("save_map", SaveMap, path="map.pcd", voxel=0.0, session=False)
        self.assertTrue(saved.success, saved.message)
        share = agreement((folder or self.folder / "out") / "map", self.offline)
        self.assertGreaterEqual(share, at_least)
        self.assertGreater(saved.removed_points, 100)

    def check_split(self, node):
        """Every point of a scan is published once, with header and fields of the input."""
        wait_for(lambda: len(node.dynamic) >= SCANS and len(node.static) >= SCANS, "the splits")
        with rosbag.Bag(str(self.bag)) as bag:
            clouds = [m for _, m, _ in bag.read_messages("/cloud")]
        for cloud, dynamic, static, report in zip(clouds, node.dynamic, node.static, node.reports):
            self.assertEqual(dynamic.header.stamp, cloud.header.stamp)
            self.assertEqual(dynamic.header.frame_id, cloud.header.frame_id)
            self.assertEqual([f.name for f in dynamic.fields], [f.name for f in cloud.fields])
            self.assertEqual(cloud_size(dynamic) + cloud_size(static) + report.dropped_points,
                             cloud_size(cloud))
            records = {cloud.data[i:i + cloud.point_step]
                       for i in range(0, len(cloud.data), cloud.point_step)}
            for i in range(0, len(dynamic.data), dynamic.point_step):
                self.assertIn(dynamic.data[i:i + dynamic.point_step], records)

    def check_run(self, node):
        play(self.bag)
        report = node.wait_for_scans(SCANS)
        self.assertEqual((report.scans, report.dropped_scans, report.skipped_scans,
                          report.tf_failures), (SCANS, 0, 0, 0))
        self.check_split(node)
        self.check_map(node)
        wait_for(lambda: node.maps and node.removed and node.matrices, "the map's topics")
        wait_for(lambda: cloud_size(node.removed[-1]) > 100, "removed points")
        self.assertEqual(node.maps[-1].header.frame_id, "map")
        self.assertGreater(len(set(node.matrices[-1].data)), 2)
        status = wait_for(lambda: [s for a in node.diagnostics for s in a.status
                                   if "map" in s.name and s.level == 0], "diagnostics")
        self.assertIn("tf failures", [v.key for v in status[-1].values])

    def test_the_node_cleans_while_a_bag_plays(self):
        with running(self.parameters()) as node:
            self.check_run(node)
            self.check_readme()

    def check_readme(self):
        """The README's tables name the topics and services that the node has."""
        publishers, _, services = rosgraph.Master("/online_test").getSystemState()
        tool_made = ("set_logger_level", "get_loggers", "parameter_descriptions",
                     "parameter_updates", "set_parameters")
        names = {name[len(NODE) + 1:] for entries in (publishers, services)
                 for name, nodes in entries if NODE in nodes and name.startswith(NODE + "/")}
        names -= set(tool_made)
        text = (PACKAGE / "README.md").read_text()
        section = text[text.index("| topic | type |"):text.index("<details><summary>Parameters of")]
        self.assertEqual(names, set(re.findall(r"^\| `~(\w+)`", section, re.M)))

    def test_the_nodelet_does_the_same(self):
        with running(self.parameters(), nodelet=True) as node:
            self.check_run(node)

    @staticmethod
    def restamped(message, time):
        """A copy of a cloud or of transforms with another stamp."""
        message = copy.deepcopy(message)
        for part in getattr(message, "transforms", [message]):
            part.header.stamp = time
        return message

    def check_published(self, nodelet):
        config = yaml.safe_load((PACKAGE / "config/paper_kitti.yaml").read_text())
        config["online"]["map_voxel"] = 0.0
        offline = self.folder / "published"
        self.run_tool("replay", self.bag, "--output", offline, "--config",
                      PACKAGE / "config/paper_kitti.yaml")
        parameters = {**config, **self.parameters(online=config["online"])}
        with running(parameters, nodelet=nodelet) as node:
            play(self.bag, rate=2.0)
            report = node.wait_for_scans(SCANS)
            self.assertEqual(report.dropped_scans, 0)
            self.assertEqual(report.thinned_scans, 0)
            for stage in ("binary_encoding", "matrix_comparison", "sight_mask",
                          "reverse_ray_casting", "fine_ground"):
                self.assertIn(stage, report.stages)
            saved = node.call("save_map", SaveMap, path="map.pcd", voxel=0.0, session=True)
            self.assertTrue(saved.success, saved.message)
            self.assertGreater(saved.removed_points, 100)
            # A single vote decides, and columns whose ground is found late had others: 0.964 here.
            self.assertGreaterEqual(agreement(self.folder / "out/map", offline), 0.95)
            node.call("reset", Empty)
            loaded = node.call("load_map", LoadMap, path="map.session")
            self.assertTrue(loaded.success, loaded.message)
            again = node.call("save_map", SaveMap, path="again.pcd", voxel=0.0, session=False)
            self.assertTrue(again.success, again.message)
            self.assertEqual(agreement(self.folder / "out/again", self.folder / "out/map"), 1.0)

    def test_the_published_method_runs_in_the_node(self):
        self.check_published(nodelet=False)
        with running(self.parameters()) as node:
            refused = node.call("load_map", LoadMap, path="map.session")
            self.assertFalse(refused.success)
            self.assertIn("published", refused.message)
            self.assertIn("evidence", refused.message)

    def test_the_published_method_runs_in_the_nodelet(self):
        self.check_published(nodelet=True)

    def test_odometry_gives_the_poses(self):
        bag = self.rewrite("odometry.bag", lambda topic, message, t:
                           [] if topic in ("/tf", "/tf_static") else [(topic, message, t)])
        with running(self.parameters(pose_source="odometry", odom_topic="/odom")) as node:
            play(bag)
            node.wait_for_scans(SCANS)
            self.check_map(node)

    def registering(self, frame="map"):
        """What turns the bag's clouds into registered ones: those of its PCD folder."""
        folder = self.folder / "registered"
        if not folder.exists():
            self.run_tool("convert", self.bag, "--output", folder)
        clouds = iter(sorted((folder / "pcd").iterdir()))

        def register(topic, message, t):
            if topic == "/cloud":
                _, points = read_pcd(next(clouds))
                message.header.frame_id = frame
                message.point_step = points.dtype.itemsize
                offsets = {n: points.dtype.fields[n][1] for n in points.dtype.names}
                for field in message.fields:
                    field.offset = offsets[field.name]
                message.row_step = len(points) * message.point_step
                message.width = len(points)
                message.data = points.tobytes()
            return [(topic, message, t)]

        return register

    def test_clouds_may_be_registered_already(self):
        bag = self.rewrite("registered.bag", self.registering())
        with running(self.parameters(sensor_frame="lidar")) as node:
            play(bag)
            node.wait_for_scans(SCANS)
            self.check_map(node)

    def test_a_map_that_is_upside_down_stays_so_and_is_cleaned(self):
        def turn(topic, message, t):
            for part in getattr(message, "transforms", []):
                if part.header.frame_id != "map":
                    continue
                p, q = part.transform.translation, part.transform.rotation
                p.y, p.z = -p.y, -p.z
                q.x, q.y, q.z, q.w = q.w, -q.z, q.y, -q.x  # after half a turn about x
            return [(topic, message, t)]

        bag = self.rewrite("turned.bag", turn)
        self.run_tool("replay", bag, "--output", self.folder / "turned")
        with running(self.parameters()) as node:
            play(bag)
            node.wait_for_scans(SCANS)
            saved = node.call("save_map", SaveMap, path="turned.pcd", voxel=0.0, session=False)
            self.assertTrue(saved.success, saved.message)
            self.assertGreater(saved.removed_points, 100)
            share = agreement(self.folder / "out/turned", self.folder / "turned")
            self.assertGreaterEqual(share, 0.99)
            wait_for(lambda: node.matrices, "the matrix")
            self.assertAlmostEqual(abs(node.matrices[-1].info.origin.orientation.x), 1.0)
            self.assertIn("up is -z of the map frame", node.output())

    def check_preset(self, preset, change):
        bag = self.rewrite(preset + ".bag", change)
        with running(launch=[str(PACKAGE / "launch/online.launch"), "preset:=" + preset,
                             "sensor:=vlp16", "map_voxel:=0",
                             f"output_folder:={self.folder / 'out'}"]) as node:
            play(bag)
            node.wait_for_scans(SCANS)
            self.check_map(node)

    @staticmethod
    def retold(message, parent, child):
        """The simulated pose as another odometry tells it."""
        parts = message.transforms if hasattr(message, "transforms") else [message]
        for part in parts:
            part.header.frame_id, part.child_frame_id = parent, child
        return message

    def test_the_preset_for_fast_lio(self):
        register = self.registering("camera_init")

        def change(topic, message, t):
            if topic == "/cloud":
                return [("/cloud_registered", register(topic, message, t)[0][1], t)]
            message = self.retold(message, "camera_init", "body")
            return [("/Odometry" if topic == "/odom" else topic, message, t)]

        self.check_preset("fast_lio", change)

    def test_the_preset_for_lio_sam(self):
        register = self.registering("odom")

        def change(topic, message, t):
            if topic == "/cloud":
                return [("/lio_sam/mapping/cloud_registered", register(topic, message, t)[0][1], t)]
            if topic == "/tf":
                return [(topic, self.retold(message, "odom", "lidar_link"), t)]
            return []

        self.check_preset("lio_sam", change)

    def test_the_preset_for_kiss_icp(self):
        def change(topic, message, t):
            if topic == "/cloud":
                return [("/kiss/frame", message, t)]
            if topic == "/odom":
                return [("/kiss/odometry", self.retold(message, "odom_lidar", "lidar"), t)]
            return []

        self.check_preset("kiss_icp", change)

    def test_the_presets_for_clouds_of_the_driver(self):
        def change(topic, message, t):
            if topic == "/cloud":
                message.header.frame_id = "velodyne"
                return [("/velodyne_points", message, t)]
            if topic == "/tf":
                moving = self.retold(message, "odom", "velodyne").transforms[0]
                base = TransformStamped(header=Header(stamp=moving.header.stamp, frame_id="map"),
                                        child_frame_id="odom")
                base.transform.rotation.w = 1.0
                return [(topic, TFMessage([base, moving]), t)]
            return []

        for preset in ("lego_loam", "hdl_graph_slam"):
            self.check_preset(preset, change)

    def test_registered_clouds_without_sensor_frame_are_refused_with_the_cure(self):
        def register(topic, message, t):
            if topic == "/cloud":
                message.header.frame_id = "map"
            return [(topic, message, t)]

        bag = self.rewrite("no_sensor.bag", register)
        with running(self.parameters()) as node:
            play(bag, rate=4.0)
            wait_for(lambda: "~sensor_frame" in node.output(), "the warning")
            self.assertFalse(node.reports)

    def test_a_missing_transform_is_named_and_counted(self):
        bag = self.rewrite("no_tf.bag", lambda topic, message, t:
                           [] if topic == "/tf" else [(topic, message, t)])
        with running(self.parameters(queue_size=10)) as node:
            play(bag)
            wait_for(lambda: "no transform from 'lidar' to 'map'" in node.output(), node.output)
            status = wait_for(lambda: [
                s for a in node.diagnostics for s in a.status
                if s.level == 2 and any(v.key == "tf failures" and int(v.value) > 0
                                        for v in s.values)], "diagnostics")
            self.assertIn("lidar", status[-1].message)
            self.assertFalse(node.reports)

    def test_a_transform_that_comes_late_is_waited_for(self):
        late = rospy.Duration(0.5)
        bag = self.rewrite("late.bag", lambda topic, message, t:
                           [(topic, message, t + late if topic == "/tf" else t)])
        with running(self.parameters()) as node:
            play(bag)
            report = node.wait_for_scans(SCANS)
            self.assertEqual((report.tf_failures, report.dropped_scans), (0, 0))
            self.assertGreater(report.latency_ms, 100.0)
            self.check_map(node)

    def test_a_looped_bag_begins_a_new_map_or_goes_on(self):
        for reset, method in ((True, "evidence"), (False, "evidence"), (True, "published")):
            with running(self.parameters(reset_on_time_jump=reset,
                                         judgement={"method": method})) as node:
                play(self.bag, rate=4.0)
                node.wait_for_scans(SCANS)
                play(self.bag, rate=4.0)
                # The transforms that come before the clock jumps are forgotten with those before.
                node.wait_for_scans(2 * SCANS - 3)
                time.sleep(0.5)
                self.assertIn("time jumped back", node.output())
                loops = node.reports[-1].map_points / len(labels_of(self.offline)[0])
                self.assertLess(abs(loops - {True: 1.0, False: 2.0}[reset]), 0.1)

    def test_clouds_out_of_order_and_unusable_ones_are_skipped_and_counted(self):
        held = []

        def spoil(topic, message, t):
            if topic != "/cloud":
                return [(topic, message, t)]
            number = message.header.seq if message.header.seq else len(held)
            held.append(number)
            if len(held) == 10:  # comes again after the next one
                spoil.old = message
            if len(held) == 12:
                return [(topic, message, t), (topic, spoil.old, t + rospy.Duration(0.01))]
            if len(held) == 15:
                message.width = message.row_step = 0
                message.data = b""
            if len(held) == 18:
                message.fields = [f for f in message.fields if f.name != "z"]
            if len(held) == 20:
                data = numpy.frombuffer(message.data, "u1").reshape(-1, message.point_step).copy()
                data[::2, :12] = 0xff  # NaN
                message.data = data.tobytes()
            return [(topic, message, t)]

        bag = self.rewrite("spoiled.bag", spoil)
        with running(self.parameters()) as node:
            play(bag)
            report = node.wait_for_scans(SCANS - 2)
            self.assertEqual((report.scans, report.skipped_scans), (SCANS - 2, 3))
            self.assertGreater(max(r.dropped_points for r in node.reports), 1000)

    def test_no_cloud_is_lost_that_comes_at_the_same_moment_as_its_pose(self):
        copies = 50

        def multiply(topic, message, t):
            if topic == "/cloud":
                # So few points that the rate is high.
                message.data = message.data[:100 * message.point_step]
                message.width, message.row_step = 100, 100 * message.point_step
            if topic not in ("/cloud", "/tf"):
                return []
            times = [t + rospy.Duration(0.1 * i / copies) for i in range(copies)]
            return [(topic, self.restamped(message, time), time) for time in times]

        bag = self.rewrite("rapid.bag", multiply)
        with running(self.parameters(queue_size=10000)) as node:
            play(bag, rate=1.0)
            report = node.wait_for_scans(copies * SCANS, timeout=60.0)
            self.assertEqual((report.scans, report.tf_failures), (copies * SCANS, 0))

    def test_two_lidars_make_one_map(self):
        count = [0]

        def split(topic, message, t):
            if topic != "/cloud":
                return [(topic, message, t)]
            count[0] += 1
            return [("/left" if count[0] % 2 else "/right", message, t)]

        bag = self.rewrite("two.bag", split)
        with running(self.parameters(cloud_topics=["/left", "/right"])) as node:
            play(bag)
            node.wait_for_scans(SCANS)
            self.check_map(node, 0.98)

    def test_what_was_saved_is_gone_on_with(self):
        with running(self.parameters()) as node:
            play(self.bag, duration=2.0)
            wait_for(lambda: len(node.reports) >= 15, "some scans")
            time.sleep(1.0)
            scans = node.reports[-1].scans
            self.assertLess(scans, SCANS)
            saved = node.call("save_map", SaveMap, path="half/a.pcd", voxel=0.0, session=True)
            self.assertTrue(saved.success, saved.message)
            points = saved.cleaned_points + saved.removed_points
            node.call("reset", Empty)
            empty = node.call("save_map", SaveMap, path="empty.pcd", voxel=0.0, session=False)
            self.assertFalse(empty.success)
            self.assertIn("empty", empty.message)
            loaded = node.call("load_map", LoadMap, path="half/a.session")
            self.assertTrue(loaded.success, loaded.message)
            again = node.call("save_map", SaveMap, path="again.pcd", voxel=0.0, session=False)
            self.assertEqual(again.cleaned_points + again.removed_points, points)
            self.assertEqual(agreement(self.folder / "out/again", self.folder / "out/half/a"), 1.0)
            node.call("pause", Empty)
            play(self.bag, duration=1.0)
            time.sleep(0.5)
            self.assertEqual(node.reports[-1].scans, scans)

    def test_services_stay_in_the_output_folder(self):
        with running(self.parameters()) as node:
            play(self.bag, rate=4.0)
            node.wait_for_scans(SCANS)
            for path in ("../a.pcd", "/tmp/beautymap_escaped.pcd", "", "a.txt"):
                saved = node.call("save_map", SaveMap, path=path, voxel=0.0, session=False)
                self.assertFalse(saved.success, path)
                self.assertTrue(saved.message)
            self.assertFalse(os.path.exists("/tmp/beautymap_escaped.pcd"))
            # A folder that cannot be written: the service says so, the map stays.
            (self.folder / "out").mkdir(exist_ok=True)
            (self.folder / "out/file.pcd").write_text("")
            saved = node.call("save_map", SaveMap, path="file.pcd/a.pcd", voxel=0.0, session=False)
            self.assertFalse(saved.success)
            self.assertTrue(node.call("save_map", SaveMap, path="a", voxel=0.5, session=False).success)
            self.assertFalse(node.call("load_map", LoadMap, path="a.session").success)
            self.assertFalse(node.call("load_map", LoadMap, path="../a.session").success)

    def test_a_full_disk_leaves_the_map_and_no_file(self):
        folder = self.folder / "full"

        def fill_disk():
            # Longer files cannot be written. Python ignores SIGXFSZ, and so does then the node: its
            # writes fail as on a full disk.
            resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 20, resource.RLIM_INFINITY))

        with running(self.parameters(output_folder=str(folder)), prepare=fill_disk) as node:
            play(self.bag, rate=4.0)
            points = node.wait_for_scans(SCANS).map_points
            # The points are too many; with fewer of them, the session is too large.
            for voxel, left in ((0.0, set()), (2.0, {"a.pcd", "a_dynamic.pcd"})):
                saved = node.call("save_map", SaveMap, path="a.pcd", voxel=voxel, session=True)
                self.assertFalse(saved.success)
                self.assertIn("File too large", saved.message)
                self.assertEqual(set(os.listdir(folder)), left)
            resource.prlimit(node.process.pid, resource.RLIMIT_FSIZE,
                             (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
            saved = node.call("save_map", SaveMap, path="a.pcd", voxel=0.0, session=True)
            self.assertTrue(saved.success, saved.message)
            self.assertEqual(saved.cleaned_points + saved.removed_points, points)
            self.check_map(node, folder=folder)

    def test_a_read_only_folder_leaves_the_map(self):
        # Not even root writes there.
        with running(self.parameters(output_folder="/proc/self")) as node:
            play(self.bag, rate=4.0)
            node.wait_for_scans(SCANS)
            for path in ("a.pcd", "folder/a.pcd"):
                saved = node.call("save_map", SaveMap, path=path, voxel=0.0, session=False)
                self.assertFalse(saved.success)
                self.assertIn("a.pcd", saved.message)
            wait_for(lambda: node.maps and cloud_size(node.maps[-1]) > 1000, "the map")

    def test_shutdown_saves_the_map_when_asked_to(self):
        with running(self.parameters(save_on_exit=True)) as node:
            play(self.bag, rate=4.0)
            node.wait_for_scans(SCANS)
            self.assertEqual(node.stop(), 0)
        self.assertEqual(len(labels_of(self.folder / "out/exit")[0]),
                         len(labels_of(self.offline)[0]))
        self.assertTrue((self.folder / "out/exit.session").exists())

    def test_a_corrected_path_makes_the_map_again(self):
        with rosbag.Bag(str(self.bag)) as bag:
            odometry = [m for _, m, _ in bag.read_messages("/odom")]
        publisher = rospy.Publisher("/corrected_path", Path, queue_size=2, latch=True)
        with running(self.parameters(loop_closure=True)) as node:
            play(self.bag)
            node.wait_for_scans(SCANS)
            path = Path()
            path.header.frame_id = "map"
            for message in odometry[::5]:
                pose = PoseStamped(header=message.header, pose=message.pose.pose)
                pose.pose.position.z += 3.0
                path.poses.append(pose)
            publisher.publish(path)
            wait_for(lambda: "the map was made again" in node.output(), "the corrected map")
            saved = node.call("save_map", SaveMap, path="map.pcd", voxel=0.0, session=False)
            self.assertTrue(saved.success, saved.message)
        publisher.unregister()
        (moved, removed), (before, removed_before) = (labels_of(self.folder / "out/map"),
                                                      labels_of(self.offline))
        self.assertEqual(len(moved), len(before))
        self.assertLess(abs(moved["z"].mean() - before["z"].mean() - 3.0), 1e-3)
        self.assertLess(abs(removed.mean() - removed_before.mean()), 0.01)

    def test_unknown_and_bad_parameters_are_refused_by_name(self):
        for parameters, expected in (({"map_frme": "map"}, "~map_frme"),
                                     ({"matrix": {"res_g": -1.0}}, "matrix.res_g"),
                                     ({"matrix": {"resolution": 1.0}}, "matrix.resolution"),
                                     ({"queue_size": 0}, "~queue_size"),
                                     ({"judgement": {"method": "guessing"}}, "judgement.method"),
                                     ({"pose_source": "gps"}, "~pose_source")):
            node = Node(self.parameters(**parameters))
            self.assertEqual(node.process.wait(timeout=20), 1)
            self.assertIn(expected, node.output())
            node.stop()

    def test_the_real_drive_gives_the_map_of_the_replay(self):
        drive = SHARED / "data/kitti_0005.bag"
        if not drive.exists():
            self.skipTest(f"{drive} is not here")
        # bz2 costs the player more time than the drive takes.
        plain = self.rewrite("plain.bag", lambda topic, message, t: [(topic, message, t)], drive)
        self.run_tool("replay", plain, "--output", self.folder / "drive")
        with running(self.parameters(cloud_topics=["/velodyne_points"])) as node:
            play(plain, rate=1.0)
            report = node.wait_for_scans(154)
            self.assertEqual(report.dropped_scans, 0)
            saved = node.call("save_map", SaveMap, path="drive.pcd", voxel=0.0, session=False)
            self.assertTrue(saved.success, saved.message)
        share = agreement(self.folder / "out/drive", self.folder / "drive")
        self.assertGreaterEqual(share, 0.99)


if __name__ == "__main__":
    rostest.rosrun("beautymap", "online", Online, sys.argv)
