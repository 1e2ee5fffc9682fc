#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 beautymap contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command line tools as a user runs them: real processes, bags and files."""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy
import rosbag
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import PACKAGE, SHARED, executable, read_pcd


def run(name, *arguments):
    return subprocess.run([executable(f"beautymap_{name}"), *map(str, arguments)],
                          capture_output=True, text=True, timeout=600, check=False)


def scores(text):
    return [float(v) for v in re.search(r"SA (\S+) DA (\S+) AA (\S+) HA (\S+)", text).groups()]


class Tools(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="beautymap-tools-"))
        cls.bag = cls.folder / "street.bag"
        done = run("simulate", "--scene", "street", "--sensor", "hdl64", "--scans", 60, "--seed", 3,
                   "--output", cls.bag)
        assert done.returncode == 0, done.stderr
        cls.result = cls.folder / "result"
        cls.replay = run("replay", cls.bag, "--output", cls.result)
        assert cls.replay.returncode == 0, cls.replay.stderr
        cls.report = json.loads((cls.result / "report.json").read_text())

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_replay_writes_everything_that_it_names(self):
        for name in ("cleaned.pcd", "dynamic.pcd", "report.json", "before.png", "after.png",
                     "matrix.png", "mistakes.png"):
            self.assertGreater((self.result / name).stat().st_size, 0, name)
        for key in ("scans", "points", "skipped", "stages_ms", "scans_per_s", "peak_memory_mb",
                    "config", "scores"):
            self.assertIn(key, self.report)
        self.assertEqual(self.report["scans"], 60)

    def test_every_point_is_either_static_or_dynamic_with_its_fields_as_recorded(self):
        _, cleaned = read_pcd(self.result / "cleaned.pcd")
        _, dynamic = read_pcd(self.result / "dynamic.pcd")
        recorded = []
        with rosbag.Bag(str(self.bag)) as bag:
            for _, cloud, _ in bag.read_messages("/cloud"):
                kinds = {2: "u1", 4: "<u2", 7: "<f4"}
                dtype = numpy.dtype({"names": [f.name for f in cloud.fields],
                                     "formats": [kinds[f.datatype] for f in cloud.fields],
                                     "offsets": [f.offset for f in cloud.fields],
                                     "itemsize": cloud.point_step})
                recorded.append(numpy.frombuffer(cloud.data, dtype))
        recorded = numpy.concatenate(recorded)
        self.assertEqual(len(recorded), self.report["points"])
        self.assertEqual(len(cleaned) + len(dynamic), len(recorded))
        names = ("intensity", "ring", "time", "label")
        both = numpy.concatenate([cleaned[list(names)], dynamic[list(names)]])
        for name in names:
            numpy.testing.assert_array_equal(numpy.sort(both[name]), numpy.sort(recorded[name]))

    def test_most_of_what_moves_is_removed_and_little_else(self):
        sa, da, _, _ = scores(self.replay.stdout)
        self.assertGreater(sa, 97.0)
        self.assertGreater(da, 90.0)

    def test_evaluate_agrees_with_the_report(self):
        folder = self.folder / "scans"
        done = run("convert", self.bag, "--output", folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        done = run("evaluate", folder / "gt_cloud.pcd", self.result / "cleaned.pcd")
        self.assertEqual(done.returncode, 0, done.stderr)
        for ours, reported in zip(scores(done.stdout), ("SA", "DA", "AA", "HA")):
            self.assertAlmostEqual(ours, self.report["scores"][reported], delta=0.0051)

    def test_a_pcd_folder_gives_the_map_that_its_bag_gives(self):
        folder = self.folder / "folder"
        self.assertEqual(run("convert", self.bag, "--output", folder).returncode, 0)
        done = run("replay", folder, "--output", self.folder / "from_folder")
        self.assertEqual(done.returncode, 0, done.stderr)
        for a, b in zip(scores(done.stdout), scores(self.replay.stdout)):
            # Coordinates are rounded to float32 in another frame: points on a cell's border differ.
            self.assertAlmostEqual(a, b, delta=0.2)

    def test_the_same_bag_gives_the_same_bytes(self):
        done = run("replay", self.bag, "--output", self.folder / "again")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.folder / "again/cleaned.pcd").read_bytes(),
                         (self.result / "cleaned.pcd").read_bytes())

    def test_what_rosbag_record_wrote_is_cleaned(self):
        recorded = self.folder / "recorded.bag"
        # Nothing here waits for a while: the recorder ends by itself when it has all, as `rosbag
        # record` does not wait for it when interrupted, and the player stays until then, as what
        # the recorder has not read yet goes with it.
        recorder = subprocess.Popen(["rosbag", "record", "-q", "--limit", "60", "-O", str(recorded),
                                     "/cloud", "/tf"])
        player = subprocess.Popen(["rosbag", "play", "-q", "-k", "--wait-for-subscribers",
                                   f"--bags={self.bag}", "--topics", "/cloud", "/tf"],
                                  stdout=subprocess.DEVNULL)
        try:
            recorder.wait(timeout=120)
        finally:
            for process in (player, recorder):
                process.terminate()
                process.wait()
        done = run("replay", recorded, "--output", self.folder / "from_recorded")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads((self.folder / "from_recorded/report.json").read_text())
        self.assertEqual(report["scans"], 60)

    def test_what_cannot_be_used_is_refused_with_a_sentence(self):
        broken = self.folder / "broken.bag"
        broken.write_bytes(b"this is no bag\n")
        truncated = self.folder / "truncated.bag"
        truncated.write_bytes(self.bag.read_bytes()[:200000])
        for arguments, expected in (
                ([broken], "broken.bag"),
                ([truncated], "rosbag reindex"),
                ([self.folder / "missing.bag"], "missing.bag"),
                ([self.bag, "--set", "matrix.res_g=-1"], "matrix.res_g = '-1'"),
                ([self.bag, "--set", "matrix.resolution=1"], "matrix.resolution"),
                ([self.bag, "--cloud-topic", "/other"], "/cloud")):
            done = run("replay", *arguments, "--output", self.folder / "refused")
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(expected, done.stderr)
        self.assertFalse((self.folder / "refused/cleaned.pcd").exists())

    def check_real_drive(self, config, at_least):
        drive = SHARED / "data/kitti_0005.bag"
        if not drive.exists():
            self.skipTest(f"{drive} is not here")
        result = self.folder / "drive"
        done = run("replay", drive, "--config", PACKAGE / "config" / config, "--output", result)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreaterEqual(scores(done.stdout)[3], at_least)
        report = json.loads((result / "report.json").read_text())
        self.assertEqual(report["scans"], 154)
        self.assertLessEqual(report["peak_memory_mb"], 600.0)

    def test_the_published_method_cleans_the_real_drive(self):
        self.check_real_drive("paper_kitti.yaml", 92.8)

    def test_the_default_cleans_the_real_drive(self):
        self.check_real_drive("default.yaml", 99.0)


if __name__ == "__main__":
    rostest.rosrun("beautymap", "tools", Tools, sys.argv)
