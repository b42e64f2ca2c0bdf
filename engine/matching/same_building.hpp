#pragma once

namespace smokemap {

/// What speaks for two maps being of one building. Every map can be laid over every other somehow, so that an answer
/// alone says nothing.
struct FitEvidence {
  double likeness = 0;   ///< of the matched regions to their partners, mean by importance, 0..1
  double explained = 0;  ///< share of a that has a partner times share of b that is one, by importance
  double lead = 0;       ///< score of the answer over that of the best one on the mirror image, which is of no building
                         ///< that is there but has rooms just like these
  int regions = 0;       ///< of the map that has fewer
  double ratio = 1;      ///< regions of the map that has more for one of the other
};

/// How likely both maps are of one building, 0..1, before which one in two was.
///
/// A logistic of the evidence, which counts the less the fewer regions there are: three rooms fit in everywhere. Fitted
/// to generated sketches of random buildings against the building itself and against four others (halls and corridors
/// of 3 to 27 rooms, a quarter of them with stubs of walls that split rooms; 480 sketches, 2400 pairs, seeds 5000 to
/// 5239, 20000 to 20119 and 40000 to 40119); neither KTH nor E5 was used. `./run bench interpretation` prints what came
/// true on generated and judged maps.
/// @param taps  regions a person has bound: whoever recognises rooms has seen the building
double same_building(const FitEvidence& evidence, int taps);

}  // namespace smokemap
