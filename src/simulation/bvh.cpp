// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/bvh.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace beautymap::simulation {
namespace {

constexpr std::size_t kLeafSize = 2;
constexpr std::size_t kMaxDepth = 64;  // halves the shapes at each level: enough for any number

bool meets(const Eigen::AlignedBox3d& box, const Ray& ray, double max_distance_m) {
  const Eigen::Array3d a = (box.min() - ray.origin).array() * ray.inverse.array();
  const Eigen::Array3d b = (box.max() - ray.origin).array() * ray.inverse.array();
  const double enter = a.min(b).maxCoeff();
  const double exit = a.max(b).minCoeff();
  return exit >= 0.0 && enter <= exit && enter <= max_distance_m;
}

}  // namespace

Bvh::Bvh(Shapes shapes) {
  if (shapes.empty()) return;
  for (const Shape& shape : shapes) {
    Eigen::AlignedBox3d bounds = boundsOf(shape);
    // A margin, so that rays which run exactly in a face are not lost to 0 times infinity.
    bounds.min().array() -= 1e-6;
    bounds.max().array() += 1e-6;
    bounds_.push_back(bounds);
  }
  std::vector<std::uint32_t> order(shapes.size());
  std::iota(order.begin(), order.end(), 0U);
  nodes_.reserve(2 * shapes.size());
  build(order, 0, order.size());
  for (const std::uint32_t index : order) shapes_.push_back(shapes[index]);
  bounds_.clear();
}

void Bvh::build(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3d bounds;
  Eigen::AlignedBox3d centers;
  for (std::size_t i = begin; i < end; ++i) {
    bounds.extend(bounds_[order[i]]);
    centers.extend(bounds_[order[i]].center());
  }
  nodes_[self].bounds = bounds;
  if (end - begin <= kLeafSize) {
    nodes_[self].first = static_cast<std::uint32_t>(begin);
    nodes_[self].count = static_cast<std::uint32_t>(end - begin);
    return;
  }
  int axis = 0;
  centers.sizes().maxCoeff(&axis);
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    const double x = bounds_[a].center()[axis];
    const double y = bounds_[b].center()[axis];
    return x < y || (x == y && a < b);
  };
  const std::size_t middle = begin + (end - begin) / 2;
  using Offset = std::vector<std::uint32_t>::difference_type;
  std::nth_element(order.begin() + static_cast<Offset>(begin),
                   order.begin() + static_cast<Offset>(middle),
                   order.begin() + static_cast<Offset>(end), before);
  build(order, begin, middle);
  nodes_[self].first = static_cast<std::uint32_t>(nodes_.size());
  build(order, middle, end);
}

const Shape* Bvh::firstOn(const Ray& ray, double& distance_m) const {
  if (nodes_.empty()) return nullptr;
  const Shape* found = nullptr;
  std::array<std::uint32_t, kMaxDepth> stack{};
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const Node& node = nodes_[index];
    if (!meets(node.bounds, ray, distance_m)) continue;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const auto distance = stopDistance(shapes_[i], ray, distance_m);
      if (!distance || *distance >= distance_m) continue;
      distance_m = *distance;
      found = &shapes_[i];
    }
    if (node.count > 0) continue;
    // The child in whose direction the ray does not look goes on the stack first.
    const Eigen::Vector3d between =
        nodes_[node.first].bounds.center() - nodes_[index + 1].bounds.center();
    const bool second_is_nearer = between.dot(ray.direction) < 0.0;
    stack[depth++] = second_is_nearer ? index + 1 : node.first;
    stack[depth++] = second_is_nearer ? node.first : index + 1;
  }
  return found;
}

}  // namespace beautymap::simulation
