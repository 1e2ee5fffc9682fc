// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <vector>

#include "beautymap/simulation/motion.h"
#include "beautymap/simulation/world.h"

namespace beautymap::simulation {

/// Somebody or something that moves: where it is, and what it looks like there.
struct Actor {
  Motion motion;
  /// Adds the body's shapes in the scene frame; the fixed part of the world is what it stands on.
  std::function<void(const Placement& place, const World& world, Shapes& shapes)> body;
};

enum class CarKind : std::uint8_t { kSedan, kVan, kTruck };

/// Shapes in the vehicle's own frame: x forward, origin on the ground below its centre.
Shapes carShapes(CarKind kind);
Shapes cyclistShapes();
Shapes forkliftShapes();

/// Pose of a vehicle on the surface that its wheels find.
Eigen::Isometry3d poseOnSurface(const Placement& place, double wheelbase_m, double track_m,
                                const World& world);

/// Adds shapes from a local frame to the scene.
void addShapes(const Shapes& local, const Eigen::Isometry3d& T_scene_local, Shapes& shapes);

Actor makeCar(CarKind kind, Motion motion);
Actor makeCyclist(Motion motion);
Actor makeForklift(Motion motion);

/// Walks with legs that swing; a planted foot stays where it is. @param height_m from sole to
/// crown.
Actor makePedestrian(double height_m, Motion motion);

}  // namespace beautymap::simulation
