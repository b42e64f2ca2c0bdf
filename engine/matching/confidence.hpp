#pragma once

#include <vector>

#include "maps/correspondence.hpp"
#include "matching/hypotheses.hpp"

namespace smokemap {

/// What speaks for a pair, each 0..1.
struct PairEvidence {
  double certainty = 0;   ///< against the alternatives of the region, all weighed together
  double likeness = 0;    ///< place and size
  double agreement = 0;   ///< of the other hypotheses, weighted by how good they are
  double is_partner = 0;  ///< 1 for a partner, 0 for a region joined because it lies under one
};

/// How likely a hypothesis is for each time that the best one is, 0..1.
double weight_beside(const Hypothesis& hypothesis, const Hypothesis& best);

PairEvidence weigh_pair(const RegionPair& pair, const std::vector<Hypothesis>& all);

/// How sure a pair is: of those said to be 0.9 sure, nine in ten are right.
///
/// A logistic of the evidence; its weights were fitted to generated sketches (tests/support/plan_pictures.hpp: people's
/// habits on random buildings, seeds 1000 and up), then lowered by one logit of caution, because right answers are
/// rarer on hand-drawn maps than on generated ones. `./run bench matching` prints what came true on both.
double confidence_of(const PairEvidence& evidence);

}  // namespace smokemap
