#include "tests/bench/foreign_figures.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <utility>

#include "matching/match.hpp"
#include "segmentation/segment.hpp"
#include "tests/bench/matching_figures.hpp"

namespace smokemap::bench {
namespace {

constexpr double kShownAsSure = 0.8;  ///< by the page
constexpr size_t kOthersPerSketch = 4;

struct ForeignSums {
  int maps = 0, fits = 0, doubtful = 0, with_sure_room = 0;
  double same_building = 0, rooms = 0, sure_rooms = 0;

  void add(const Matching& matching) {
    int sure = 0, proposed = 0;
    for (const RegionPair& pair : matching.pairs) {
      if (pair.verdict != Verdict::kProposed) continue;
      ++proposed;
      sure += pair.confidence >= kShownAsSure;
    }
    maps += 1, fits += matching.same_building >= kFitsFrom, doubtful += matching.doubtful;
    with_sure_room += sure > 0, same_building += matching.same_building;
    rooms += proposed, sure_rooms += sure;
  }
  void print(const std::string& set, const char* over) const {
    if (maps == 0) return;
    std::printf("%-10s %-38s %4d %7.2f %7.2f %8.2f %12.2f %10.3f\n", set.c_str(), over, maps, same_building / maps,
                double(fits) / maps, double(doubtful) / maps, double(with_sure_room) / maps,
                rooms > 0 ? sure_rooms / rooms : 0);
  }
};

std::string building_of(const JudgedPair& pair) {
  return pair.set == "generated" || pair.set == "stubs" ? pair.set + pair.name : pair.set.substr(0, pair.set.find('_'));
}

/// Somebody confirms the two largest rooms as they are shown.
std::vector<RegionPair> believed(const JudgedPair& pair, const Matching& shown) {
  std::vector<RegionPair> pairs = shown.pairs;
  std::stable_sort(pairs.begin(), pairs.end(), [&](const RegionPair& one, const RegionPair& two) {
    return pair.a.regions[static_cast<size_t>(one.label_a - 1)].area_px >
           pair.a.regions[static_cast<size_t>(two.label_a - 1)].area_px;
  });
  if (pairs.size() > 2) pairs.resize(2);
  for (RegionPair& one : pairs) one.verdict = Verdict::kConfirmed;
  return pairs;
}

std::vector<Pin> true_taps(const JudgedPair& pair, size_t count) {
  std::vector<Pin> pins;
  for (const JudgedGroup& group : pair.groups)
    if (pins.size() < count && !group.clicks_a.empty() && !group.clicks_b.empty())
      pins.push_back({group.clicks_a.front(), group.clicks_b.front()});
  return pins;
}

Segmentation mirror_image(const Segmentation& map) {
  cv::Mat mirrored;
  cv::flip(map.labels, mirrored, 1);
  return *segmentation_from_labels(mirrored);
}

struct Said {
  std::vector<std::pair<double, bool>> building_own, building_other, room_own, room_other;
};

void print_buildings(const Said& said) {
  std::printf("    of one building (said: true, own and other alike):");
  for (const auto& [low, high] : {std::pair(0.0, 0.1), {0.1, 0.3}, {0.3, 0.5}, {0.5, 0.7}, {0.7, 0.9}, {0.9, 1.01}}) {
    const auto share = [low = low, high = high](const std::vector<std::pair<double, bool>>& list) {
      const auto count = std::count_if(list.begin(), list.end(),
                                       [&](const auto& one) { return one.first >= low && one.first < high; });
      return list.empty() ? 0.0 : double(count) / double(list.size());
    };
    const double own = share(said.building_own), other = share(said.building_other);
    std::printf("  %.1f-%.1f %.2f", low, std::min(1.0, high), own + other > 0 ? own / (own + other) : 0.0);
  }
  std::printf("\n");
  std::vector<std::pair<double, bool>> rooms = said.room_own;  // as many rooms of other buildings as of their own
  for (size_t i = 0; i < said.room_own.size() && !said.room_other.empty(); ++i)
    rooms.push_back(said.room_other[i * said.room_other.size() / said.room_own.size()]);
  print_reliability(rooms);
}

void add_own(const JudgedPair& pair, std::map<std::string, ForeignSums>& rows, Said& said) {
  const auto matcher = Matcher::create(pair.a, pair.b);
  if (!matcher) return;
  const Matching matching = *matcher->solve({}, {});
  rows["1 own"].add(matching);
  said.building_own.emplace_back(matching.same_building, true);
  const PairFigures figures = judge_answer(pair, matching, {});
  said.room_own.insert(said.room_own.end(), figures.said.begin(), figures.said.end());
  rows["2 own, two right taps"].add(*matcher->solve(true_taps(pair, 2), {}));
  if (const auto turned = match(pair.a, mirror_image(pair.b))) rows["3 mirror image of its own"].add(*turned);
}

void add_other(const JudgedPair& pair, const Segmentation& other, std::map<std::string, ForeignSums>& rows,
               Said& said) {
  const auto matcher = Matcher::create(pair.a, other);
  if (!matcher) return;
  const Matching matching = *matcher->solve({}, {});
  rows["4 other building"].add(matching);
  said.building_other.emplace_back(matching.same_building, false);
  for (const RegionPair& one : matching.pairs) said.room_other.emplace_back(one.confidence, false);
  rows["5 other, two wrong rooms confirmed"].add(*matcher->solve({}, believed(pair, matching)));
}

}  // namespace

void print_foreign_figures(const std::vector<JudgedPair>& pairs, const std::vector<Segmentation>& others) {
  std::printf("%-10s %-38s %4s %7s %7s %8s %12s %10s\n", "set", "laid over", "n", "mean p", "fits", "doubtful",
              "any sure", "rooms sure");
  std::set<std::string> sets, drawings;
  for (const JudgedPair& pair : pairs) sets.insert(pair.set);
  Said said;
  for (const std::string& set : sets) {
    std::map<std::string, ForeignSums> rows;
    for (size_t i = 0; i < pairs.size(); ++i) {
      const JudgedPair& pair = pairs[i];
      if (pair.set != set || !drawings.insert(pair.set + "/" + pair.name).second) continue;
      add_own(pair, rows, said);
      std::set<std::string> seen = {building_of(pair)};
      for (size_t k = 1; k < pairs.size() && seen.size() <= kOthersPerSketch; ++k) {
        const JudgedPair& next = pairs[(i + k) % pairs.size()];
        if (seen.insert(building_of(next)).second) add_other(pair, next.b, rows, said);
      }
      for (size_t k = 0; k < std::min(others.size(), kOthersPerSketch); ++k)
        add_other(pair, others[(i + k) % others.size()], rows, said);
    }
    for (const auto& [over, sums] : rows) sums.print(set, over.c_str() + 2);
  }
  print_buildings(said);
  std::fflush(stdout);
}

Result<std::vector<Segmentation>> read_robot_maps(const std::string& folder, const Segmenter& segmenter) {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(folder) / "robot_maps"))
    if (std::filesystem::exists(entry.path() / "map.png")) files.insert(entry.path() / "map.png");
  std::vector<Segmentation> maps;
  bool is_turn = true;
  for (const auto& file : files) {
    if (is_turn) {
      const auto free_space = free_space_of_picture(cv::imread(file.string(), cv::IMREAD_GRAYSCALE));
      if (!free_space) return fail(free_space.error().code, file.string() + ": " + free_space.error().message);
      auto segmentation = segmenter(*free_space);
      if (!segmentation) return segmentation.error();
      maps.push_back(std::move(*segmentation));
    }
    is_turn = !is_turn;
  }
  return maps;
}

}  // namespace smokemap::bench
