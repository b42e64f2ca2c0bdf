#pragma once

#include <array>
#include <vector>

namespace smokemap {

/// Lines of a drawing, side by side, each of which may lie anywhere within a reach of where it is thought to be.
/// Neighbouring strips between them are stretched alike (first-order Gauss-Markov, as NeighbourStretchCost has it).
struct LineChain {
  static constexpr int kReach_cells = 80;
  static constexpr double kCell_m = 0.05;
  static constexpr int kPlaces = 2 * kReach_cells + 1;
  /// What speaks for a line at `now_m + (i - kReach_cells) * kCell_m`, natural logarithm of odds.
  using Support = std::array<float, kPlaces>;

  std::vector<double> drawn_m;   ///< ascending, times the plan's scale
  std::vector<double> now_m;     ///< where they are thought to be
  std::vector<Support> support;  ///< one per line
  double sigma_stretch = 0.10;
  double correlation_m = 2.4;
};

/// Where one line of a chain lies.
struct LineBelief {
  static constexpr double kNear_m = 0.35;  ///< a line not farther away is where it was thought to be

  /// To another place, and how much more (log odds) what was sensed speaks for it there.
  struct Move {
    double move_m = 0;
    double gain = 0;
  };
  Move together;         ///< to the most plausible arrangement of all lines
  Move alone;            ///< to where this line by itself most probably is, over all arrangements
  double elsewhere = 0;  ///< probability that it is not near where it was thought to be
  double apart_m = 0;    ///< rms distance to there, if it is elsewhere
};

/// The most plausible arrangement of all lines, and how sure each is of the place where it is thought to be: max- and
/// sum-product over place and local stretch, exact but for the grid of 5 cm and 5 %, with strips at least 0.7 and at
/// most 1.5 times as wide as drawn. It does not start from the present arrangement, so it finds a strip that was caught
/// one wall too far, from which no small step leads back. Cost: lines x 40 000. Deterministic.
std::vector<LineBelief> arrange_lines(const LineChain& chain);

}  // namespace smokemap
