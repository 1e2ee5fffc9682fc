// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_history.h"

#include <algorithm>

#include "scan_files.h"
#include "stamps.h"
#include "text.h"
#include "tf_history.h"

namespace beautymap {
namespace {

constexpr std::uint64_t kSlackNs = 1'000'000;
constexpr std::uint64_t kLargestGapNs = 1'000'000'000;

}  // namespace

void OdometryHistory::insert(const nav_msgs::Odometry& message) {
  const auto& t = message.pose.pose.position;
  const auto& q = message.pose.pose.orientation;
  Eigen::Isometry3d pose;
  if (!isPlausible(message.header.stamp) ||
      !makePose({t.x, t.y, t.z}, {q.w, q.x, q.y, q.z}, pose)) {
    ++unusable_;
    return;
  }
  if (map_frame_.empty()) {
    map_frame_ = stripSlash(message.header.frame_id);
    child_frame_ = stripSlash(message.child_frame_id);
  }
  const Sample sample{message.header.stamp.toNSec(), pose.translation(),
                      Eigen::Quaterniond(pose.linear()).coeffs()};
  if (!samples_.empty() && samples_.back().stamp_ns == sample.stamp_ns) return;
  sorted_ = sorted_ && (samples_.empty() || samples_.back() < sample);
  samples_.push_back(sample);
}

void OdometryHistory::finish() {
  if (sorted_) return;
  std::stable_sort(samples_.begin(), samples_.end());
  const auto same = [](const Sample& a, const Sample& b) { return a.stamp_ns == b.stamp_ns; };
  samples_.erase(std::unique(samples_.begin(), samples_.end(), same), samples_.end());
  sorted_ = true;
}

void OdometryHistory::forgetBefore(std::uint64_t stamp_ns) {
  finish();
  const auto keep = std::find_if(samples_.begin(), samples_.end(),
                                 [&](const Sample& sample) { return sample.stamp_ns >= stamp_ns; });
  samples_.erase(samples_.begin(), keep);
}

bool OdometryHistory::isStillToCome(std::uint64_t stamp_ns) const {
  return samples_.empty() || stamp_ns > samples_.back().stamp_ns + kSlackNs;
}

std::optional<Eigen::Isometry3d> OdometryHistory::lookup(std::uint64_t stamp_ns,
                                                         std::string& why) const {
  if (samples_.empty()) {
    why = "there are no usable odometry messages";
    return std::nullopt;
  }
  const std::uint64_t begin_ns = samples_.front().stamp_ns;
  const std::uint64_t end_ns = samples_.back().stamp_ns;
  if (stamp_ns + kSlackNs < begin_ns || stamp_ns > end_ns + kSlackNs) {
    why = "the odometry covers " + inSeconds(begin_ns) + " to " + inSeconds(end_ns);
    return std::nullopt;
  }
  stamp_ns = std::clamp(stamp_ns, begin_ns, end_ns);
  const auto next = std::lower_bound(
      samples_.begin(), samples_.end(), stamp_ns,
      [](const Sample& sample, std::uint64_t stamp) { return sample.stamp_ns < stamp; });
  const auto previous = next->stamp_ns == stamp_ns ? next : next - 1;
  const std::uint64_t gap_ns = next->stamp_ns - previous->stamp_ns;
  if (gap_ns > kLargestGapNs) {
    why = "the odometry has a gap from " + inSeconds(previous->stamp_ns) + " to " +
          inSeconds(next->stamp_ns);
    return std::nullopt;
  }
  const double share = gap_ns == 0 ? 0.0
                                   : static_cast<double>(stamp_ns - previous->stamp_ns) /
                                         static_cast<double>(gap_ns);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = (1.0 - share) * previous->translation + share * next->translation;
  pose.linear() = Eigen::Quaterniond(previous->rotation)
                      .slerp(share, Eigen::Quaterniond(next->rotation))
                      .toRotationMatrix();
  return pose;
}

}  // namespace beautymap
