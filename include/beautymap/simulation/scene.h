// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "beautymap/simulation/actor.h"
#include "beautymap/simulation/ground.h"
#include "beautymap/simulation/shape.h"

namespace beautymap::simulation {

/// How the sensor is carried.
enum class Carrier : std::uint8_t { kVehicle, kHandheld };

/// A place, who moves in it and how the sensor goes through it. Scene frame: z up, z = 0 near the
/// ground.
struct Scene {
  Shapes fixed;
  Ground ground;
  std::vector<Actor> actors;
  Motion sensor;
  Carrier carrier = Carrier::kVehicle;
};

/// @param name one of sceneNames(). @param duration_s length of the recording: streets are as long
/// as it takes, waiting cars leave in its middle.
/// @throws std::invalid_argument for another name.
Scene makeScene(const std::string& name, double duration_s, std::uint64_t seed);
std::vector<std::string> sceneNames();

Scene makeStreet(double duration_s, std::uint64_t seed);
Scene makeWaiting(double duration_s, std::uint64_t seed);
Scene makeSlope(double duration_s, std::uint64_t seed);
Scene makeBridge(std::uint64_t seed);
Scene makeHall(double duration_s, std::uint64_t seed);
Scene makeCrowd(double duration_s, std::uint64_t seed);
Scene makeStairs(double duration_s, std::uint64_t seed);
Scene makeFar(std::uint64_t seed);

}  // namespace beautymap::simulation
