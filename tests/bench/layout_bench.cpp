// How well and how fast plans are read: ./run bench layout [--seeds N] [--data DIR [--plans DIR]] [--pictures DIR]
// Random buildings drawn as evacuation plans (simulation; seeds 1, 2, ...), read flat ("clean"), turned, blurred and
// noisy ("scan"; every third one a gray copy; "gray": all of them as gray copies), and photographed. With --data also
// pictures with known truth: NAME.json (walls, doors, corners, rooms in pixels; "image" may name a picture below
// --plans) beside NAME.png or NAME.jpg.
// --pictures keeps what was read. Then how far confidences can be trusted, and what hostile files come to. Scores as in
// layout_figures.hpp. Taps = what a scripted person would do from the first reading to the right plan: one tap for a
// false wall, one drag for a missing one or for a corner of the sheet that is off by over half a percent. One thread's
// processor time.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "layout/read_layout.hpp"
#include "recording/file_bytes.hpp"
#include "recording/picture_file.hpp"
#include "simulation/plan_picture.hpp"
#include "simulation/random_building.hpp"
#include "tests/bench/bench_options.hpp"
#include "tests/bench/layout_figures.hpp"

namespace {

using namespace smokemap;
using bench::PlanFigures;
using bench::PlanTruth;

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Row {
  PlanFigures figures;
  double sheet_percent = -1;  ///< mean error of the sheet's corners, of its side
  double sheet_confidence = 0;
  double cpu_s = 0;
  double scale_sigmas = -1;  ///< error of the guessed scale in its own sigmas; -1 = none
};

Point2 through(const std::array<double, 9>& H, const Point2& p) {
  const double z = H[6] * p.x() + H[7] * p.y() + H[8];
  return {(H[0] * p.x() + H[1] * p.y() + H[2]) / z, (H[3] * p.x() + H[4] * p.y() + H[5]) / z};
}

PlanTruth truth_of(const LayoutMap& map, const std::function<Point2(const Point2&)>& place) {
  PlanTruth truth;
  std::vector<std::vector<double>> headings(map.corners.size());
  for (std::size_t w = 0; w < map.walls.size(); ++w) {
    const Segment2 s = map.wall_px(static_cast<int>(w));
    truth.walls.push_back({place(s.a), place(s.b)});
    for (const int c : {map.walls[w].corner_a, map.walls[w].corner_b})
      headings[static_cast<std::size_t>(c)].push_back(s.heading());
  }
  for (std::size_t c = 0; c < headings.size(); ++c)
    if (std::any_of(headings[c].begin(), headings[c].end(),
                    [&](double h) { return line_angle_between(h, headings[c].front()) > radians(20); }))
      truth.corners.push_back(place(map.corners[c].p_px));
  for (const auto& o : map.openings) truth.openings.push_back({place(o.gap_px.a), place(o.gap_px.b)});
  for (auto room : map.rooms_px) {
    for (auto& p : room) p = place(p);
    truth.rooms.push_back(std::move(room));
  }
  for (auto sign : map.signs) {
    sign.p_px = place(sign.p_px);
    truth.signs.push_back(sign);
  }
  return truth;
}

std::string pictures_folder;  ///< where the pictures go that are read, if anywhere

/// @param name  of the picture, in the line that is printed
Row read_and_measure(const std::string& name, const cv::Mat& picture, const PlanTruth& truth,
                     LayoutReading* kept = nullptr) {
  if (!pictures_folder.empty()) cv::imwrite(pictures_folder + "/" + name + ".png", picture);
  Row row;
  const double begin = thread_seconds();
  auto reading = read_layout(picture);
  row.cpu_s = thread_seconds() - begin;
  if (!reading) {
    std::printf("  %-28s not read: %s\n", name.c_str(), reading.error().message.c_str());
    return row;
  }
  row.figures = bench::measure_plan(reading->layout, truth);
  std::printf("  %-28s wall F1 %.3f corner %.3f room %.3f taps %d cpu %.2f s%s\n", name.c_str(),
              row.figures.walls.value(), row.figures.corners.value(), row.figures.rooms.value(), row.figures.taps,
              row.cpu_s, reading->layout.warnings.empty() ? "" : (", " + reading->layout.warnings.front()).c_str());
  if (kept) *kept = std::move(*reading);
  return row;
}

/// A copier's view of the sheet: a little askew, soft, noisy.
cv::Mat scan_of(const cv::Mat& sheet, int seed, bool gray, cv::Mat& turn) {
  turn =
      cv::getRotationMatrix2D(cv::Point2f(0.5F * static_cast<float>(sheet.cols), 0.5F * static_cast<float>(sheet.rows)),
                              seed % 2 ? 1.1 : -0.7, 1);
  cv::Mat scan;
  cv::warpAffine(sheet, scan, turn, sheet.size(), cv::INTER_AREA, cv::BORDER_CONSTANT, cv::Scalar(255, 255, 255));
  cv::GaussianBlur(scan, scan, {5, 5}, 0.9);
  if (gray) {
    cv::cvtColor(scan, scan, cv::COLOR_BGR2GRAY);
    cv::cvtColor(scan, scan, cv::COLOR_GRAY2BGR);
  }
  cv::Mat noise(scan.size(), CV_16SC1), deep;
  cv::RNG(static_cast<std::uint64_t>(seed)).fill(noise, cv::RNG::NORMAL, 0, 4);
  cv::merge(std::vector<cv::Mat>{noise, noise, noise}, noise);
  scan.convertTo(deep, CV_16SC3);
  deep += noise;
  deep.convertTo(scan, CV_8UC3);
  return scan;
}

using Rows = std::map<std::string, std::vector<Row>>;

bool add_renderings(int seed, Rows& rows) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  const auto building = random_building({}, random);
  if (!building) return false;
  const auto plan = distort(*building, {}, random);
  if (!plan) return false;
  PlanPictureParams params;
  params.width_px = 2400;
  params.photo = true;
  const auto picture = draw_plan(plan->drawn, params, random);
  if (!picture) return false;
  const auto truth = true_layout(*plan, *picture);
  const auto flat = truth_of(truth.layout, [](const Point2& p) { return p; });
  LayoutReading reading;
  Row clean = read_and_measure("clean_" + std::to_string(seed), picture->sheet, flat, &reading);
  if (const auto& scale = reading.layout.scale)
    clean.scale_sigmas =
        std::abs(std::log(scale->metres_per_pixel / picture->metres_per_pixel)) / scale->relative_sigma;
  rows["clean"].push_back(clean);

  cv::Mat turn;
  const cv::Mat scan = scan_of(picture->sheet, seed, seed % 3 == 0, turn);
  const auto turned = truth_of(truth.layout, [&](const Point2& p) {
    return Point2(turn.at<double>(0, 0) * p.x() + turn.at<double>(0, 1) * p.y() + turn.at<double>(0, 2),
                  turn.at<double>(1, 0) * p.x() + turn.at<double>(1, 1) * p.y() + turn.at<double>(1, 2));
  });
  rows["scan"].push_back(read_and_measure("scan_" + std::to_string(seed), scan, turned));
  rows["gray"].push_back(
      read_and_measure("gray_" + std::to_string(seed), scan_of(picture->sheet, seed, true, turn), turned));

  const auto& H = picture->homography.H_layout_photo;
  const cv::Mat inverse = cv::Mat(3, 3, CV_64F, const_cast<double*>(H.data())).inv();
  std::array<double, 9> back{};
  for (int i = 0; i < 9; ++i) back[static_cast<std::size_t>(i)] = inverse.at<double>(i / 3, i % 3);
  Row photo = read_and_measure("photo_" + std::to_string(seed), picture->photo,
                               truth_of(truth.layout, [&](const Point2& p) { return through(back, p); }), &reading);
  const double w = picture->sheet.cols - 1, h = picture->sheet.rows - 1;
  const std::array<Point2, 4> corners{Point2(0, 0), Point2(w, 0), Point2(w, h), Point2(0, h)};
  photo.sheet_percent = 0;
  photo.sheet_confidence = reading.sheet_confidence;
  for (std::size_t i = 0; i < 4; ++i) {
    const double off = 100 * (through(H, reading.sheet_corners_px[i]) - corners[i]).norm() / w;
    photo.sheet_percent += off / 4;
    photo.figures.taps += off > 0.5;
  }
  rows["photo"].push_back(photo);
  return true;
}

void add_pictures(const std::string& data, const std::string& plans, Rows& rows) {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(data))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    std::string image;
    const auto truth = bench::read_truth(file.string(), &image);
    if (truth.walls.empty()) continue;
    std::vector<fs::path> candidates;
    for (const char* extension : {".png", ".jpg"}) candidates.push_back(fs::path(file).replace_extension(extension));
    if (!image.empty() && !plans.empty())
      for (const auto& entry : fs::recursive_directory_iterator(plans))
        if (entry.path().filename() == fs::path(image).filename()) candidates.push_back(entry.path());
    const auto picture =
        std::find_if(candidates.begin(), candidates.end(), [](const auto& p) { return fs::exists(p); });
    if (picture == candidates.end()) continue;
    const auto bytes = read_file(picture->string(), PictureLimits{}.max_bytes);
    const auto decoded = bytes ? decode_picture(*bytes) : Result<cv::Mat>(bytes.error());
    if (!decoded) continue;
    rows[file.parent_path().filename().string()].push_back(read_and_measure(file.stem(), *decoded, truth));
  }
}

void print_table(const Rows& rows) {
  std::printf("%-10s %5s %8s %6s %8s %7s %5s %7s %9s %11s %5s %6s\n", "kind", "plans", "wall F1", "worst", "corner F1",
              "room F1", "off", "sheet", "signs R/P", "taps median", "max", "cpu s");
  for (const auto& [kind, list] : rows) {
    const double n = static_cast<double>(list.size());
    double wall = 0, worst = 1, corner = 0, room = 0, off = 0, sheet = 0, cpu = 0, truth = 0, found = 0, wrong = 0;
    std::vector<int> taps;
    for (const auto& r : list) {
      const auto& f = r.figures;
      wall += f.walls.value(), worst = std::min(worst, f.walls.value()), corner += f.corners.value();
      room += f.rooms.value(), off += f.rooms_off, sheet += r.sheet_percent, cpu = std::max(cpu, r.cpu_s);
      truth += f.signs_true, found += f.signs_found, wrong += f.signs_wrong;
      taps.push_back(f.taps);
    }
    std::sort(taps.begin(), taps.end());
    std::printf("%-10s %5.0f %8.3f %6.3f %8.3f %7.3f %5.1f %6.2f%% %4.2f/%4.2f %11d %5d %6.2f\n", kind.c_str(), n,
                wall / n, worst, corner / n, room / n, off / n, sheet / n, truth > 0 ? found / truth : 0,
                found + wrong > 0 ? found / (found + wrong) : 0, taps[taps.size() / 2], taps.back(), cpu);
  }
}

void print_trust(const Rows& rows, bool corners) {
  int said = 0, right = 0, all = 0;
  const double from = corners ? 0.85 : 0.9;
  for (const auto& [kind, list] : rows)
    for (const auto& r : list)
      for (const auto& [confidence, is_right] : corners ? r.figures.said_corners : r.figures.said_walls) {
        all += 1;
        if (confidence >= from) said += 1, right += is_right;
      }
  std::printf("%s said >= %.2f: %d of %d, right %.3f\n", corners ? "corners" : "walls", from, said, all,
              said ? static_cast<double>(right) / said : 0);
}

void print_sheets(const std::vector<Row>& photos) {
  constexpr double kWithinPercent = 0.5, kSure = 0.9;
  int within = 0, sure = 0, sure_within = 0;
  for (const Row& row : photos) {
    const bool good = row.sheet_percent <= kWithinPercent, said = row.sheet_confidence >= kSure;
    within += good, sure += said, sure_within += good && said;
  }
  std::printf("sheet corners within %.1f %% of the side: %d of %zu photographs; said >= %.1f: %d, of them within: %d\n",
              kWithinPercent, within, photos.size(), kSure, sure, sure_within);
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  std::string data, plans;
  int seeds = 6;
  bench::BenchOptions("How well and how fast plans are read")
      .text("--data", data, "folder with pictures of known truth")
      .text("--plans", plans, "folder with the pictures that they name")
      .text("--pictures", pictures_folder, "folder for what was read")
      .number("--seeds", seeds, "drawn buildings")
      .read(argc, argv);
  Rows rows;
  for (int seed = 1; seed <= seeds; ++seed)
    if (!add_renderings(seed, rows)) return 1;
  if (!data.empty() && std::filesystem::is_directory(data)) add_pictures(data, plans, rows);
  print_table(rows);
  print_trust(rows, false);
  print_trust(rows, true);
  print_sheets(rows["photo"]);
  int guessed = 0, within = 0;
  for (const auto& row : rows["clean"])
    if (row.scale_sigmas >= 0) guessed += 1, within += row.scale_sigmas <= 2;
  std::printf("scale guessed %d, within two sigma %d\n", guessed, within);
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  std::printf("peak memory %ld MiB (the drawings included)\n", used.ru_maxrss / 1024);
  bench::print_hostile_files();
}
