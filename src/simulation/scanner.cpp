// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/scanner.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <thread>

#include "beautymap/simulation/random.h"

namespace beautymap::simulation {
namespace {

using Eigen::Vector3d;

/// A surface that was measured, perhaps over a mirror.
struct Echo {
  double distance_m = 0.0;
  double strength = 0.0;  ///< received power relative to 10 % reflectivity at right angles and 1 m
  bool moving = false;
};

double strengthOf(const Hit& hit, const Vector3d& direction, double distance_m) {
  // Real surfaces are rougher than Lambert's: flat beams return more than the cosine says.
  const double facing = std::sqrt(std::abs(hit.normal.dot(direction)));
  return hit.material.reflectivity / 0.1 * facing / (distance_m * distance_m);
}

std::optional<Echo> mirrored(const World& world, const Ray& ray, const Hit& mirror,
                             double max_range_m) {
  const Vector3d direction = ray.direction - 2.0 * ray.direction.dot(mirror.normal) * mirror.normal;
  const Ray second(ray.at(mirror.distance_m) + 1e-4 * mirror.normal, direction,
                   hashOf(ray.key, 0x313));
  const auto hit = world.cast(second, max_range_m - mirror.distance_m);
  if (!hit || hit->moving) return std::nullopt;
  const double distance = mirror.distance_m + hit->distance_m;
  return Echo{distance, strengthOf(*hit, direction, distance), false};
}

std::optional<Echo> firstEcho(const World& world, const Ray& ray, double max_range_m) {
  const auto hit = world.cast(ray, max_range_m);
  if (!hit) return std::nullopt;
  if (hit->material.mirror > 0.0) {
    // A share of the panes' returns, so of the beams that were not transmitted.
    const double share = hit->material.mirror / (1.0 - hit->material.transmission);
    const bool facing = hit->normal.dot(ray.direction) < 0.0;
    if (facing && unitFromBits(hashOf(ray.key, 0x9a1)) < share) {
      return mirrored(world, ray, *hit, max_range_m);
    }
  }
  return Echo{hit->distance_m, strengthOf(*hit, ray.direction, hit->distance_m), hit->moving};
}

std::optional<Return> measure(const World& world, const ScanRequest& request, const Beam& beam,
                              std::size_t index) {
  constexpr double kAlwaysLost = 0.025;
  const SensorModel& sensor = request.sensor;
  const std::uint64_t key = hashOf(request.seed, request.scan, index);
  const Ray ray(request.T_scene_sensor.translation(),
                request.T_scene_sensor.linear() * beam.direction, key);
  const auto echo = firstEcho(world, ray, sensor.max_range_m);
  if (!echo || echo->distance_m < sensor.min_range_m) return std::nullopt;
  Random random(hashOf(key, 0x4015e));
  const double margin = echo->strength * sensor.range_at_10pct_m * sensor.range_at_10pct_m;
  const double detected = (1.0 - kAlwaysLost) * (1.0 - std::exp(-3.0 * margin));
  if (!random.chance(detected)) return std::nullopt;
  const double range = echo->distance_m + sensor.range_sigma_m * random.normal();
  if (range < sensor.min_range_m || range > sensor.max_range_m) return std::nullopt;
  Return result;
  result.position = (range * beam.direction).cast<float>();
  const double brightness = echo->strength * echo->distance_m * echo->distance_m;
  result.intensity = static_cast<float>(
      std::round(std::clamp(25.5 * brightness * (1.0 + 0.1 * random.normal()), 0.0, 255.0)));
  result.time_s = beam.time_s;
  result.ring = beam.ring;
  result.moving = echo->moving;
  return result;
}

}  // namespace

std::vector<Return> takeScan(const World& world, const ScanRequest& request) {
  const std::vector<Beam> beams = beamsOfScan(request.sensor, request.seed, request.scan);
  const auto parts = static_cast<std::size_t>(std::max(1, request.threads));
  std::vector<std::vector<Return>> returns(parts);
  const auto castPart = [&](std::size_t part) {
    const std::size_t end = beams.size() * (part + 1) / parts;
    for (std::size_t i = beams.size() * part / parts; i < end; ++i) {
      if (const auto point = measure(world, request, beams[i], i)) returns[part].push_back(*point);
    }
  };
  std::vector<std::thread> workers;
  for (std::size_t part = 1; part < parts; ++part) workers.emplace_back(castPart, part);
  castPart(0);
  for (std::thread& worker : workers) worker.join();
  for (std::size_t part = 1; part < parts; ++part) {
    returns[0].insert(returns[0].end(), returns[part].begin(), returns[part].end());
  }
  return std::move(returns[0]);
}

}  // namespace beautymap::simulation
