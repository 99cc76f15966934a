// Toughness by example: the γ at which a hit like this one breaks into so many pieces.
//
// PredictDegree stops at the first N with E_D(N) < γ. So the same hit, grown by the same seed, has exactly N
// sites for every γ with E_D(N) < γ ≤ min E_D(1 … N − 1). Taken is the geometric mean of the two ends, which
// is farthest from both in proportion: small changes of the hit don't change the number.
#pragma once

#include "base/exec.h"
#include "base/result.h"
#include "types/fields.h"
#include "types/partition.h"

namespace sherd {

struct CalibrateToughnessParams {
  int pieces = 20;        ///< N ≥ 1, sites
  std::int64_t seed = 1;  ///< that of the PredictDegree that will use it: it then has exactly N for this hit
};

/// `pinned`: as for predictDegree, or null. γ in J·m², > 0. With N = 1, which has no upper end, twice E_D(1):
/// the body withstands a hit of nearly twice the energy. Where E_D(N) is 0 (every node that weighs has a
/// site), half the upper end. Says the number. Errors: those of cvd (sizes, finiteness); N < 1; no energy at
/// all; fewer than N nodes that weigh, and an N at which E_D doesn't fall, since no γ gives these: both with
/// the nearest N that can be had; `pinned` without pins; 1 < N < pins. Cost: that of PredictDegree up to N.
Result<double> calibrateToughness(const WeightField& weights, const Embedding& embedding, const Sites* pinned,
                                  const CalibrateToughnessParams& params, const Exec& exec);

}  // namespace sherd
