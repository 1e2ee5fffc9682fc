// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/simulation/scene.h"

#include <stdexcept>

namespace beautymap::simulation {

std::vector<std::string> sceneNames() {
  return {"street", "waiting", "slope", "bridge", "hall", "crowd", "stairs", "far"};
}

Scene makeScene(const std::string& name, double duration_s, std::uint64_t seed) {
  if (name == "street") return makeStreet(duration_s, seed);
  if (name == "waiting") return makeWaiting(duration_s, seed);
  if (name == "slope") return makeSlope(duration_s, seed);
  if (name == "bridge") return makeBridge(seed);
  if (name == "hall") return makeHall(duration_s, seed);
  if (name == "crowd") return makeCrowd(duration_s, seed);
  if (name == "stairs") return makeStairs(duration_s, seed);
  if (name == "far") return makeFar(seed);
  std::string message = "scene: '" + name + "' is not one of";
  for (const std::string& known : sceneNames()) message += " " + known;
  throw std::invalid_argument(message);
}

}  // namespace beautymap::simulation
