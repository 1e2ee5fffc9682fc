// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "scan_poses.h"

#include <algorithm>
#include <utility>

#include "text.h"

namespace beautymap {
namespace {

std::string inQuotes(const std::string& frame) { return "'" + frame + "'"; }

std::string frameList(const TfHistory& tf) { return "frames in tf: " + join(tf.frames()); }

std::string unusableNote(const TfHistory& tf) {
  if (tf.unusable() == 0) return "";
  return std::to_string(tf.unusable()) +
         " transforms are unusable, the first: " + tf.unusableExample();
}

void requireFrame(const TfHistory& tf, const std::string& option, const std::string& frame) {
  if (tf.knows(frame)) return;
  throw InputError("tf has no frame " + inQuotes(frame) + " (" + option + "); " + frameList(tf));
}

[[noreturn]] void refuseUnknownSensor(const TfHistory& tf, const std::string& why) {
  throw InputError(why +
                   ": they are registered already and do not say where the sensor was. Give the "
                   "sensor's frame with --sensor-frame; " +
                   frameList(tf));
}

std::string chooseMapFrame(const TfHistory& tf, const std::string& wanted) {
  if (!wanted.empty()) {
    requireFrame(tf, "--map-frame", wanted);
    return wanted;
  }
  if (tf.knows("map")) return "map";
  const auto roots = tf.roots();
  if (roots.size() == 1) return roots.front();
  throw InputError("the map frame is not clear: tf has no frame 'map' and " +
                   std::to_string(roots.size()) + " roots (" + join(roots) +
                   "). Name it with --map-frame; " + frameList(tf));
}

/// Poses from tf, interpolated by tf2 at the cloud's stamp.
class TfPoses : public ScanPoses {
 public:
  TfPoses(TfHistory tf, const SourceOptions& options, std::string cloud_frame)
      : tf_(std::move(tf)),
        map_frame_(chooseMapFrame(tf_, stripSlash(options.map_frame))),
        sensor_frame_(stripSlash(options.sensor_frame)),
        cloud_frame_(std::move(cloud_frame)) {
    if (!sensor_frame_.empty()) {
      requireFrame(tf_, "--sensor-frame", sensor_frame_);
      return;
    }
    if (cloud_frame_ == map_frame_) {
      refuseUnknownSensor(tf_, "the clouds are in the map frame " + inQuotes(map_frame_));
    }
    if (standsStillAboveMovingFrames()) {
      refuseUnknownSensor(tf_, "the clouds are in " + inQuotes(cloud_frame_) +
                                   ", which other frames move in and which does not move in " +
                                   inQuotes(map_frame_) + " like a sensor");
    }
  }

  bool find(const std::string& cloud_frame, std::uint64_t stamp_ns, SourceScan& scan,
            std::string& reason) override {
    if (cloud_frame == map_frame_ && sensor_frame_.empty()) {
      reason = "cloud in the map frame, without --sensor-frame";
      return false;
    }
    const std::string& sensor_frame = sensor_frame_.empty() ? cloud_frame : sensor_frame_;
    const auto T_map_cloud = find(cloud_frame, stamp_ns, reason);
    if (!T_map_cloud) return false;
    const auto T_map_sensor =
        sensor_frame == cloud_frame ? T_map_cloud : find(sensor_frame, stamp_ns, reason);
    if (!T_map_sensor) return false;
    scan.T_map_cloud = *T_map_cloud;
    scan.T_map_sensor = *T_map_sensor;
    return true;
  }

  std::string explain(const std::string& cloud_frame, std::uint64_t stamp_ns) const override {
    const std::string& frame = sensor_frame_.empty() ? cloud_frame : sensor_frame_;
    std::string text = "scan at " + inSeconds(stamp_ns) + ": ";
    for (const std::string& needed : {cloud_frame, frame}) {
      if (needed == map_frame_) continue;
      if (!tf_.knows(needed)) {
        return text + "tf has no frame " + inQuotes(needed) +
               " (is its static transform missing?); " + frameList(tf_) + unusable();
      }
      if (tf_.chain(needed).back() != tf_.chain(map_frame_).back()) {
        return text + inQuotes(needed) + " and " + inQuotes(map_frame_) +
               " are not connected; roots of tf: " + join(tf_.roots()) + unusable();
      }
    }
    const auto covered = tf_.coverage(frame);
    if (!covered) return text + frameList(tf_) + unusable();
    text += "tf covers " + inSeconds(covered->first) + " to " + inSeconds(covered->second) +
            " for " + inQuotes(frame);
    if (stamp_ns >= covered->first && stamp_ns <= covered->second) return text + unusable();
    return text + ", and nothing is extrapolated" + clockAdvice(stamp_ns, *covered) + unusable();
  }

  std::vector<std::string> describe() const override {
    std::vector<std::string> lines{"poses: tf, map frame " + inQuotes(map_frame_) + ", chain " +
                                   join(tf_.chain(cloud_frame_), " < ")};
    if (cloud_frame_ == map_frame_) {
      lines.push_back("the clouds are registered in the map frame; the sensor is at " +
                      inQuotes(sensor_frame_));
    } else if (!sensor_frame_.empty()) {
      lines.push_back("the beams start at " + inQuotes(sensor_frame_));
    }
    const auto chain = tf_.chain(sensor_frame_.empty() ? cloud_frame_ : sensor_frame_);
    if (std::none_of(chain.begin(), chain.end(),
                     [&](const auto& frame) { return tf_.isDynamic(frame); })) {
      lines.push_back("WARNING: tf holds static transforms only on the way to " +
                      inQuotes(map_frame_) + ": the sensor never moves");
    }
    if (tf_.unusable() > 0) lines.push_back("WARNING: " + unusableNote(tf_));
    return lines;
  }

 private:
  std::optional<Eigen::Isometry3d> find(const std::string& frame, std::uint64_t stamp_ns,
                                        std::string& reason) {
    auto pose = tf_.lookup(map_frame_, frame, stamp_ns);
    if (!pose) {
      reason = "no transform from " + inQuotes(frame) + " to " + inQuotes(map_frame_) +
               " at the scan's stamp";
    }
    return pose;
  }

  /// LIO-SAM registers its clouds in `odom` below `map`: a frame in which the robot moves and which
  /// itself hardly does.
  bool standsStillAboveMovingFrames() {
    if (!tf_.hasDynamicDescendant(cloud_frame_) || !tf_.knows(cloud_frame_)) return false;
    if (cloud_frame_ == "odom") return true;
    const auto covered = tf_.coverage(cloud_frame_);
    if (!covered) return true;
    const auto [begin, end] = *covered;
    if (begin >= end) return false;
    const auto first = tf_.lookup(map_frame_, cloud_frame_, begin);
    for (const std::uint64_t stamp_ns : {begin + (end - begin) / 2, end}) {
      const auto later = tf_.lookup(map_frame_, cloud_frame_, stamp_ns);
      constexpr double kStill = 1e-3;  // [m] and of the rotation matrix
      if (!first || !later || !first->isApprox(*later, kStill)) return false;
    }
    return true;
  }

  static std::string clockAdvice(std::uint64_t stamp_ns,
                                 const std::pair<std::uint64_t, std::uint64_t>& covered) {
    constexpr std::uint64_t kOtherClockNs = 3'600'000'000'000;
    const bool other_clock =
        stamp_ns + kOtherClockNs < covered.first || stamp_ns > covered.second + kOtherClockNs;
    return other_clock ? "; the clouds seem to be stamped by another clock than tf" : "";
  }

  std::string unusable() const {
    const std::string note = unusableNote(tf_);
    return note.empty() ? "" : "; " + note;
  }

  TfHistory tf_;
  std::string map_frame_;
  std::string sensor_frame_;
  std::string cloud_frame_;
};

/// Poses of the odometry's child frame in the frame of its header.
class OdometryPoses : public ScanPoses {
 public:
  OdometryPoses(OdometryHistory odometry, TfHistory tf, const SourceOptions& options,
                std::string cloud_frame)
      : odometry_(std::move(odometry)),
        tf_(std::move(tf)),
        topic_(options.odom_topic),
        map_frame_(odometry_.mapFrame()),
        child_frame_(odometry_.childFrame()),
        sensor_frame_(stripSlash(options.sensor_frame)),
        cloud_frame_(std::move(cloud_frame)) {
    const std::string wanted = stripSlash(options.map_frame);
    if (!wanted.empty() && wanted != map_frame_) {
      throw InputError("--map-frame is " + inQuotes(wanted) + ", but the odometry on " + topic_ +
                       " is in " + inQuotes(map_frame_) + ": leave --map-frame out");
    }
    if (!sensor_frame_.empty() && sensor_frame_ != child_frame_ && !isBesideChild(sensor_frame_)) {
      throw InputError("tf has no transform from the odometry's child frame " +
                       inQuotes(child_frame_) + " to " + inQuotes(sensor_frame_) +
                       " (--sensor-frame); " + frameList(tf_));
    }
  }

  bool find(const std::string& cloud_frame, std::uint64_t stamp_ns, SourceScan& scan,
            std::string& reason) override {
    std::string why;
    const auto T_map_child = odometry_.lookup(stamp_ns, why);
    if (!T_map_child) {
      reason = "no odometry at the scan's stamp";
      return false;
    }
    const auto T_child_sensor = fromChild(sensor_frame_, stamp_ns);
    const auto T_child_cloud = fromChild(cloud_frame, stamp_ns);
    if (!T_child_sensor || !T_child_cloud) {
      reason = "no transform from the odometry's child frame " + inQuotes(child_frame_) +
               " at the scan's stamp";
      return false;
    }
    const bool is_registered = isRegistered(cloud_frame);
    scan.T_map_cloud =
        is_registered ? Eigen::Isometry3d::Identity() : *T_map_child * *T_child_cloud;
    scan.T_map_sensor =
        is_registered || !sensor_frame_.empty() ? *T_map_child * *T_child_sensor : scan.T_map_cloud;
    return true;
  }

  std::string explain(const std::string&, std::uint64_t stamp_ns) const override {
    std::string why = frameList(tf_);
    odometry_.lookup(stamp_ns, why);
    return "scan at " + inSeconds(stamp_ns) + ": " + why;
  }

  std::vector<std::string> describe() const override {
    std::vector<std::string> lines{
        "poses: odometry on " + topic_ + ", " + std::to_string(odometry_.size()) + " poses of " +
        inQuotes(child_frame_) + " in the map frame " + inQuotes(map_frame_)};
    if (isRegistered(cloud_frame_)) {
      lines.push_back("the clouds are registered in the map frame; the sensor is at " +
                      inQuotes(sensor_frame_.empty() ? child_frame_ : sensor_frame_));
    } else if (cloud_frame_ != child_frame_) {
      lines.push_back(isBesideChild(cloud_frame_)
                          ? "from " + inQuotes(child_frame_) + " to the clouds' frame " +
                                inQuotes(cloud_frame_) + " by tf"
                          : "tf does not connect " + inQuotes(child_frame_) +
                                " and the clouds' frame " + inQuotes(cloud_frame_) +
                                ": the odometry is taken as the pose of the clouds");
    }
    if (odometry_.unusable() > 0) {
      lines.push_back("WARNING: " + std::to_string(odometry_.unusable()) +
                      " odometry messages are unusable: not finite, or a quaternion far from "
                      "length 1");
    }
    return lines;
  }

 private:
  bool isRegistered(const std::string& cloud_frame) const { return cloud_frame == map_frame_; }

  /// Whether tf connects a frame with the odometry's child frame.
  bool isBesideChild(const std::string& frame) const {
    return tf_.knows(frame) && tf_.knows(child_frame_) &&
           tf_.chain(frame).back() == tf_.chain(child_frame_).back();
  }

  /// T_child_frame; frames that tf does not know are taken for the child frame itself.
  std::optional<Eigen::Isometry3d> fromChild(const std::string& frame, std::uint64_t stamp_ns) {
    const bool is_child = frame.empty() || frame == child_frame_ || isRegistered(frame);
    if (is_child || !isBesideChild(frame)) return Eigen::Isometry3d::Identity();
    return tf_.lookup(child_frame_, frame, stamp_ns);
  }

  OdometryHistory odometry_;
  TfHistory tf_;
  std::string topic_;
  std::string map_frame_;
  std::string child_frame_;
  std::string sensor_frame_;
  std::string cloud_frame_;
};

}  // namespace

std::unique_ptr<ScanPoses> posesFromTf(TfHistory tf, const SourceOptions& options,
                                       const std::string& cloud_frame) {
  return std::make_unique<TfPoses>(std::move(tf), options, cloud_frame);
}

std::unique_ptr<ScanPoses> posesFromOdometry(OdometryHistory odometry, TfHistory tf,
                                             const SourceOptions& options,
                                             const std::string& cloud_frame) {
  return std::make_unique<OdometryPoses>(std::move(odometry), std::move(tf), options, cloud_frame);
}

}  // namespace beautymap
