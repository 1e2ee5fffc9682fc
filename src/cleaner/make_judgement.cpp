// SPDX-FileCopyrightText: 2026 beautymap contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "beautymap/cleaner/make_judgement.h"

#include "beautymap/evidence/evidence_judgement.h"
#include "beautymap/published/published_judgement.h"

namespace beautymap {

std::unique_ptr<const Judgement> makeJudgement(const Config& config) {
  checkConfig(config);
  const std::string& method = config.judgement.method;
  if (method == "evidence") return std::make_unique<EvidenceJudgement>(config);
  if (method == "published") return std::make_unique<PublishedJudgement>(config);
  throw ConfigError("parameter judgement.method = '" + method + "' has no judgement");
}

}  // namespace beautymap
