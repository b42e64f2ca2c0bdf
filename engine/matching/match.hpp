#pragma once

#include <memory>
#include <vector>

#include "core/result.hpp"
#include "maps/correspondence.hpp"
#include "maps/segmentation.hpp"
#include "matching/match_params.hpp"

namespace smokemap {

/// Finds which regions of map a (a sketch, a layout, a robot's partial map) and of map b are the same places.
///
/// Neither scale nor heading nor completeness is assumed. Pins bind the regions they lie in; confirmed and rejected
/// verdicts are kept exactly. What cannot be told is left unmatched, and every pair says how sure it
/// is; one that is wrong nine times in ten is not said at all.
///
/// @param pins      p_a_px on a, p_b_px on b; pins off free space bind the nearest region within 10 px, else nothing
/// @param verdicts  confirmed pairs come back confirmed with confidence 1; rejected ones come back rejected and are
/// never
///                  proposed; proposed ones are ignored; labels that do not exist are kConflict
/// @return pairs, worst confidence first. kDegenerate if a map has no region, kInvalidArgument for bad parameters.
/// Cost: some 60 ms for some tens of regions. Deterministic.
Result<Matching> match(const Segmentation& a, const Segmentation& b, const std::vector<Pin>& pins = {},
                       const std::vector<RegionPair>& verdicts = {}, const MatchParams& params = {});

/// The same for two maps that stay while people tap: what does not depend on taps is worked out once, a further
/// answer takes half the time. Gives the same answers as match(). Keeps what it needs of the maps; copies share it.
class Matcher {
 public:
  static Result<Matcher> create(const Segmentation& a, const Segmentation& b, const MatchParams& params = {});
  Result<Matching> solve(const std::vector<Pin>& pins, const std::vector<RegionPair>& verdicts) const;

 private:
  struct Maps;
  explicit Matcher(std::shared_ptr<const Maps> maps);
  std::shared_ptr<const Maps> maps_;
};

}  // namespace smokemap
