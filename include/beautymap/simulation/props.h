// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "beautymap/simulation/actor.h"
#include "beautymap/simulation/random.h"
#include "beautymap/simulation/shape.h"

namespace beautymap::simulation {

/// Furniture of the scenes. `foot` is where a thing stands on the ground.
void addTree(const Eigen::Vector3d& foot, Random& random, Shapes& shapes);
void addLampPost(const Eigen::Vector3d& foot, double toward_yaw_rad, Shapes& shapes);
void addSign(const Eigen::Vector3d& foot, double yaw_rad, Shapes& shapes);
void addBin(const Eigen::Vector3d& foot, Shapes& shapes);
void addBench(const Eigen::Vector3d& foot, double yaw_rad, Shapes& shapes);
void addTable(const Eigen::Vector3d& foot, const Eigen::Vector2d& size, double yaw_rad,
              Shapes& shapes);
/// Open shelves with goods on each board.
void addShelf(const Eigen::Vector3d& foot, double length_m, double yaw_rad, Random& random,
              Shapes& shapes);
/// A bus stop's shelter: three glass walls below a roof, open towards -y of its own frame.
void addShelter(const Eigen::Vector3d& foot, double yaw_rad, Shapes& shapes);
/// A framed pane from one point of the floor to another.
void addPane(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double height_m,
             Shapes& shapes);
/// A wall between two points of the ground, half a metre deep in it, so that slopes leave no gap.
void addWall(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double height_m,
             double thickness_m, const Material& material, Shapes& shapes);
void addParkedCar(const Eigen::Isometry3d& pose, CarKind kind, Shapes& shapes);

}  // namespace beautymap::simulation
