#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/result.hpp"
#include "geometry/similarity2.hpp"

namespace smokemap {

/// A plan is not rigid. This is the map from one plane to another given by where a set of nodes went:
/// exact at the nodes, piecewise affine over their Delaunay mesh, continuous, invertible where no triangle folds, and
/// continued by the best similarity outside: between the nodes' hull and a box around it the two are blended by further
/// triangles. Immutable; copies share their mesh. Cost: building O(n^1.5), asking O(1).
class Deformation {
 public:
  /// The identity.
  Deformation();
  /// @param pairs p_b = node before (source frame), p_a = the same node after (target frame). Two or more distinct
  /// ones;
  ///              nodes closer than 1 mm in the source are merged; triangles that would fold are relaxed towards the
  ///              similarity (then `folded()` is true and those nodes are no longer met exactly).
  /// kDegenerate for fewer than two distinct nodes.
  static Result<Deformation> build(const std::vector<PointPair>& pairs);
  static Deformation from_similarity(const Similarity2& similarity);

  Point2 operator()(const Point2& p_source) const;
  /// The place before. Always answers: outside the mesh by the inverse similarity.
  Point2 inverse(const Point2& p_target) const;
  /// One standard deviation per coordinate of the image of `p_source`, interpolated from the nodes' sigmas.
  double sigma_m(const Point2& p_source) const;
  /// Change of length at a point relative to the overall scale: 1 = undistorted. For the local scale map.
  double local_scale(const Point2& p_source) const;
  /// Best over all nodes; the identity for the identity.
  const Similarity2& similarity() const;
  /// The mesh as it was built, for drawing a picture warped: nodes before and after, triangles counter-clockwise in the
  /// source frame. Its outermost ring is a box around the nodes, carried by the similarity. Empty for a bare
  /// similarity.
  const std::vector<Point2>& mesh_source() const;
  const std::vector<Point2>& mesh_target() const;
  const std::vector<std::array<int, 3>>& mesh_triangles() const;
  bool folded() const;

 private:
  struct Mesh;
  std::shared_ptr<const Mesh> mesh_;
};

}  // namespace smokemap
