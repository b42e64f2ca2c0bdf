#include "acg/acg_params.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/result_matchers.hpp"

namespace smokemap {
namespace {

using test::Fails;
using test::IsOk;

struct AcgField {
  const char* name;
  double AcgParams::*value;
};

constexpr AcgField kAcgFields[] = {
    {"sigma_wall_log_length", &AcgParams::sigma_wall_log_length},
    {"sigma_wall_turn_rad", &AcgParams::sigma_wall_turn_rad},
    {"sigma_corner_draw_m", &AcgParams::sigma_corner_draw_m},
    {"stretch_length_m", &AcgParams::stretch_length_m},
    {"sigma_point_m", &AcgParams::sigma_point_m},
    {"sigma_end_m", &AcgParams::sigma_end_m},
    {"sigma_seen_corner_m", &AcgParams::sigma_seen_corner_m},
    {"min_piece_m", &AcgParams::min_piece_m},
    {"node_spacing_m", &AcgParams::node_spacing_m},
    {"gate_start_m", &AcgParams::gate_start_m},
    {"gate_end_m", &AcgParams::gate_end_m},
    {"gate_angle_rad", &AcgParams::gate_angle_rad},
    {"mature_m", &AcgParams::mature_m},
    {"new_wall_min_m", &AcgParams::new_wall_min_m},
    {"missing_share", &AcgParams::missing_share},
    {"moved_m", &AcgParams::moved_m},
    {"fits_above", &AcgParams::fits_above},
    {"fits_not_below", &AcgParams::fits_not_below},
};

TEST(AcgParams, RefuseInEveryFieldWhatIsNoNumberOrNegative) {
  for (const AcgField& field : kAcgFields)
    for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity(), -1.0}) {
      AcgParams bad;
      bad.*field.value = wrong;
      EXPECT_THAT(bad.validate(), Fails(Errc::kInvalidArgument)) << field.name << " = " << wrong;
    }
}

TEST(AcgParams, NameTheFieldThatIsWrong) {
  for (const AcgField& field : kAcgFields) {
    AcgParams bad;
    bad.*field.value = -1;
    const auto checked = bad.validate();
    ASSERT_FALSE(checked.ok()) << field.name;
    // The upper threshold of a pair also bounds the lower one.
    const std::string& said = checked.error().message;
    const bool pair = field.value == &AcgParams::fits_above;
    EXPECT_NE(said.find(pair ? "fits_not_below" : field.name), std::string::npos) << said;
  }
}

TEST(AcgParams, KeepTheirPairsInOrderAndTheirCountsWithinReason) {
  AcgParams params;
  params.gate_end_m = params.gate_start_m;
  params.fits_not_below = params.fits_above;
  EXPECT_THAT(params.validate(), IsOk());
  params.gate_end_m = params.gate_start_m + 0.01;
  EXPECT_THAT(params.validate(), Fails(Errc::kInvalidArgument));
  params = {};
  params.fits_not_below = params.fits_above + 0.01;
  EXPECT_THAT(params.validate(), Fails(Errc::kInvalidArgument));
  for (int AcgParams::*count : {&AcgParams::rounds, &AcgParams::covariance_every})
    for (const int wrong : {-1, 0, 1001}) {
      params = {};
      params.*count = wrong;
      EXPECT_THAT(params.validate(), Fails(Errc::kInvalidArgument)) << wrong;
    }
}

}  // namespace
}  // namespace smokemap
