// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "beautymap/config/config.h"
#include "beautymap/judgement/judgement.h"

namespace beautymap {

/// The judgement that judgement.method names.
/// @throws ConfigError when the configuration is out of range or contradicts itself.
std::unique_ptr<const Judgement> makeJudgement(const Config& config);

}  // namespace beautymap
