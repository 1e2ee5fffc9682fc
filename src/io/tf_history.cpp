// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "tf_history.h"

#include <tf2/exceptions.h>

#include <algorithm>

#include "scan_files.h"
#include "stamps.h"

namespace beautymap {
namespace {

constexpr std::uint64_t kStretchNs = 10'000'000'000;
constexpr double kForeverS = 1e9;

template <typename Sample>
bool earlier(const Sample& sample, std::uint64_t stamp_ns) {
  return sample.stamp_ns < stamp_ns;
}

template <typename Sample>
geometry_msgs::TransformStamped toMessage(const std::string& child, const Sample& sample) {
  geometry_msgs::TransformStamped message;
  message.header.stamp.fromNSec(sample.stamp_ns);
  message.header.frame_id = *sample.parent;
  message.child_frame_id = child;
  message.transform.translation.x = sample.translation.x();
  message.transform.translation.y = sample.translation.y();
  message.transform.translation.z = sample.translation.z();
  message.transform.rotation.x = sample.rotation.x();
  message.transform.rotation.y = sample.rotation.y();
  message.transform.rotation.z = sample.rotation.z();
  message.transform.rotation.w = sample.rotation.w();
  return message;
}

}  // namespace

std::string stripSlash(const std::string& frame) {
  return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame;
}

void TfHistory::insert(const geometry_msgs::TransformStamped& transform, bool is_static) {
  const std::string parent = stripSlash(transform.header.frame_id);
  const std::string child = stripSlash(transform.child_frame_id);
  const auto& t = transform.transform.translation;
  const auto& q = transform.transform.rotation;
  Eigen::Isometry3d pose;
  // tf2 would refuse these one by one, with a message on the console for each.
  if (parent.empty() || child.empty() || parent == child || !isPlausible(transform.header.stamp) ||
      !makePose({t.x, t.y, t.z}, {q.w, q.x, q.y, q.z}, pose)) {
    if (unusable_++ == 0) {
      unusable_example_ = "'" + parent + "' -> '" + child +
                          "': a frame without name or its own child, not finite, farther than "
                          "10000 km, a quaternion far from length 1, or a stamp after 2033";
    }
    return;
  }
  const Eigen::Quaterniond rotation(pose.linear());
  const Sample sample{transform.header.stamp.toNSec(), &*names_.insert(parent).first,
                      pose.translation(), rotation.coeffs()};
  parents_[child] = parent;
  buffer_.reset();
  if (is_static) {
    static_.insert_or_assign(child, sample);
    return;
  }
  auto& samples = dynamic_[child];
  if (!samples.empty() && samples.back().stamp_ns == sample.stamp_ns) return;
  sorted_ = sorted_ && (samples.empty() || samples.back().stamp_ns < sample.stamp_ns);
  samples.push_back(sample);
}

void TfHistory::finish() {
  if (sorted_) return;
  for (auto& [child, samples] : dynamic_) {
    std::stable_sort(samples.begin(), samples.end(),
                     [](const auto& a, const auto& b) { return earlier(a, b.stamp_ns); });
    const auto same = [](const auto& a, const auto& b) { return a.stamp_ns == b.stamp_ns; };
    samples.erase(std::unique(samples.begin(), samples.end(), same), samples.end());
  }
  sorted_ = true;
}

void TfHistory::loadStretch(std::uint64_t stretch) {
  if (buffer_ != nullptr && loaded_stretch_ == stretch) return;
  buffer_ = std::make_unique<tf2::BufferCore>(ros::Duration(kForeverS));
  loaded_stretch_ = stretch;
  for (const auto& [child, sample] : static_) {
    buffer_->setTransform(toMessage(child, sample), "bag", true);
  }
  for (const auto& [child, samples] : dynamic_) {
    // A frame that is static as well keeps its static pose, as in tf2.
    if (static_.count(child) > 0) continue;
    auto first =
        std::lower_bound(samples.begin(), samples.end(), stretch * kStretchNs, earlier<Sample>);
    auto last = std::lower_bound(first, samples.end(), (stretch + 1) * kStretchNs, earlier<Sample>);
    // One more on each side, to interpolate from and to.
    if (first != samples.begin()) --first;
    if (last != samples.end()) ++last;
    for (auto it = first; it != last; ++it) {
      buffer_->setTransform(toMessage(child, *it), "bag", false);
    }
  }
}

std::optional<Eigen::Isometry3d> TfHistory::lookup(const std::string& target,
                                                   const std::string& source,
                                                   std::uint64_t stamp_ns, std::string* why) {
  if (target == source) return Eigen::Isometry3d::Identity();
  loadStretch(stamp_ns / kStretchNs);
  try {
    ros::Time time;
    time.fromNSec(stamp_ns);
    const auto found = buffer_->lookupTransform(target, source, time).transform;
    Eigen::Isometry3d pose;
    const auto& t = found.translation;
    const auto& q = found.rotation;
    if (makePose({t.x, t.y, t.z}, {q.w, q.x, q.y, q.z}, pose)) return pose;
    if (why != nullptr) *why = "the transform is not finite";
  } catch (const std::exception& error) {  // tf2's, and ros::Time's for stamps after the year 2106
    if (why != nullptr) *why = error.what();
  }
  return std::nullopt;
}

bool TfHistory::knows(const std::string& frame) const {
  return parents_.count(frame) > 0 || names_.count(frame) > 0;
}

std::vector<std::string> TfHistory::frames() const {
  std::set<std::string> all = names_;
  for (const auto& [child, parent] : parents_) all.insert(child);
  return {all.begin(), all.end()};
}

std::vector<std::string> TfHistory::roots() const {
  std::set<std::string> roots;
  for (const auto& [child, parent] : parents_) {
    if (parents_.count(parent) == 0) roots.insert(parent);
  }
  return {roots.begin(), roots.end()};
}

std::vector<std::string> TfHistory::chain(std::string frame) const {
  std::vector<std::string> frames{frame};
  for (auto it = parents_.find(frame); it != parents_.end(); it = parents_.find(frame)) {
    frame = it->second;
    // A tree with a loop has no root.
    if (std::find(frames.begin(), frames.end(), frame) != frames.end()) break;
    frames.push_back(frame);
  }
  return frames;
}

bool TfHistory::hasDynamicDescendant(const std::string& frame) const {
  return std::any_of(dynamic_.begin(), dynamic_.end(), [&](const auto& entry) {
    if (entry.first == frame) return false;
    const auto above = chain(entry.first);
    return std::find(above.begin(), above.end(), frame) != above.end();
  });
}

std::optional<std::pair<std::uint64_t, std::uint64_t>> TfHistory::coverage(
    const std::string& frame) const {
  std::optional<std::pair<std::uint64_t, std::uint64_t>> range;
  for (const std::string& link : chain(frame)) {
    const auto it = dynamic_.find(link);
    if (it == dynamic_.end() || static_.count(link) > 0) continue;
    const std::uint64_t first = it->second.front().stamp_ns;
    const std::uint64_t last = it->second.back().stamp_ns;
    if (!range) range.emplace(first, last);
    range->first = std::max(range->first, first);
    range->second = std::min(range->second, last);
  }
  return range;
}

}  // namespace beautymap
