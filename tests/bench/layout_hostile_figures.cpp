// Files that mean harm, or are odd, made here byte by byte, and what the intake says to each.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <span>
#include <string>

#include "layout/read_layout.hpp"
#include "recording/picture_file.hpp"
#include "simulation/plan_picture.hpp"
#include "simulation/random_building.hpp"
#include "tests/bench/layout_figures.hpp"
#include "tests/support/cmyk_jpeg.hpp"
#include "tests/support/pdf_files.hpp"

namespace smokemap::bench {
namespace {

using FileBytes = std::vector<std::uint8_t>;

FileBytes from_text(const std::string& text) { return {text.begin(), text.end()}; }

FileBytes encode(const char* extension, const cv::Mat& picture) {
  FileBytes bytes;
  cv::imencode(extension, picture, bytes);
  return bytes;
}

void put_size(FileBytes& png, std::uint32_t width, std::uint32_t height) {
  for (std::size_t i = 0; i < 4; ++i) {
    png[16 + i] = static_cast<std::uint8_t>(width >> (24 - 8 * i));
    png[20 + i] = static_cast<std::uint8_t>(height >> (24 - 8 * i));
  }
}

FileBytes png_that_claims(std::uint32_t width, std::uint32_t height) {
  auto bytes = encode(".png", cv::Mat(8, 8, CV_8UC3, cv::Scalar(255, 255, 255)));
  put_size(bytes, width, height);
  return bytes;
}

cv::Mat plan_like(int width, int height) {
  cv::Mat picture(height, width, CV_8UC3, cv::Scalar(255, 255, 255));
  for (int i = 1; i < 8; ++i) {
    picture.rowRange(i * height / 8, i * height / 8 + 12).setTo(0);
    picture.colRange(i * width / 8, i * width / 8 + 12).setTo(0);
  }
  return picture;
}

FileBytes cut(FileBytes bytes, double share) {
  bytes.resize(static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
  return bytes;
}

/// A drawn plan as a camera takes it, grain and all: what a decoder and a reader have to do depends on it.
FileBytes photograph_of_plan(int width, int height) {
  std::mt19937_64 random(1);
  const auto building = random_building({}, random);
  if (!building) return {};
  PlanPictureParams params;
  params.width_px = width;
  params.photo = true;
  const auto picture = draw_plan(*building, params, random);
  if (!picture) return {};
  cv::Mat photograph;
  cv::resize(picture->photo, photograph, cv::Size(width, height));
  return encode(".jpg", photograph);
}

double wall_seconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double cpu_seconds() {
  double sum = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    getrusage(who, &used);
    sum += static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  }
  return sum;
}

long peak_mib() {
  long most = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    getrusage(who, &used);
    most = std::max(most, used.ru_maxrss / 1024);
  }
  return most;
}

/// Runs `work` in a process of its own, so that the memory it takes is its own, and prints what it cost and said.
void row(const char* name, std::size_t bytes, const std::function<std::string()>& work) {
  std::fflush(stdout);
  const pid_t pid = fork();
  if (pid != 0) {
    int status = 0;
    waitpid(pid, &status, 0);
    if (!WIFEXITED(status)) std::printf("  %-34s CRASHED\n", name);
    return;
  }
  const long before = peak_mib();  // what the fork gave it
  const double begin = cpu_seconds(), wall = wall_seconds();
  const std::string said = work();
  std::printf("  %-34s %6zu kB %6.2f cpu s %6.2f s %+5ld MiB  %s\n", name, bytes / 1000, cpu_seconds() - begin,
              wall_seconds() - wall, peak_mib() - before, said.c_str());
  std::fflush(stdout);
  _exit(0);
}

std::string intake_says(std::span<const std::uint8_t> bytes, const PictureLimits& limits, int page) {
  const auto picture = decode_picture(bytes, limits, page);
  if (!picture) return "refused: " + picture.error().message;
  std::string answer = std::to_string(picture->cols) + " x " + std::to_string(picture->rows) + " px";
  for (const auto& warning : picture_warnings(bytes)) answer += "; " + warning;
  return answer;
}

void intake_row(const char* name, const FileBytes& bytes) {
  row(name, bytes.size(), [&] { return intake_says(bytes, {}, 0); });
}

void pdf_row(const test::PdfFile& file, const PictureLimits& limits = {}, int page = 0) {
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(file.bytes.data()), file.bytes.size());
  row(file.name, bytes.size(), [&] { return intake_says(bytes, limits, page); });
}

/// A photograph of a plan at so many pixels, taken in and read.
void reading_row(const char* name, int width, int height) {
  const FileBytes bytes = photograph_of_plan(width, height);
  row(name, bytes.size(), [&]() -> std::string {
    const auto picture = decode_picture(bytes);
    if (!picture) return "refused: " + picture.error().message;
    const double taken_in = cpu_seconds();
    const auto reading = read_layout(*picture);
    if (!reading) return "not read: " + reading.error().message;
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.2f", cpu_seconds() - taken_in);
    return std::to_string(reading->layout.walls.size()) + " walls, " + seconds + " cpu s of it reading";
  });
}

void print_odd_pictures() {
  const cv::Mat plan = plan_like(1200, 900);
  intake_row("empty file", {});
  intake_row("junk", FileBytes(200'000, 0xA5));
  intake_row("1 x 1", encode(".png", cv::Mat(1, 1, CV_8UC3, cv::Scalar(0, 0, 0))));
  intake_row("PNG that claims 30000 x 30000", png_that_claims(30000, 30000));
  intake_row("PNG that claims 6000 x 6000", png_that_claims(6000, 6000));
  intake_row("JPEG cut at two thirds", cut(encode(".jpg", plan), 0.67));
  intake_row("PNG cut in the middle", cut(encode(".png", plan), 0.5));
  FileBytes large = encode(".png", plan);
  large.resize(26'000'000, 0);
  intake_row("26 MB", large);
  intake_row("TIFF", from_text(std::string("II*\0\x08\0\0\0", 8)));
  intake_row("16 bit", encode(".png", cv::Mat(600, 800, CV_16UC3, cv::Scalar(30000, 40000, 50000))));
  intake_row("alpha", encode(".png", cv::Mat(600, 800, CV_8UC4, cv::Scalar(0, 0, 0, 100))));
  intake_row("WebP", encode(".webp", plan));
  intake_row("CMYK as Adobe stores it", test::inverted_cmyk_jpeg());
  intake_row("CMYK as luminance", test::ycck_jpeg());
  intake_row("CMYK without Adobe's mark", test::unmarked_cmyk_jpeg());
  intake_row("40 MP, PNG of one colour", encode(".png", cv::Mat(5000, 8000, CV_8UC1, cv::Scalar(255))));
  intake_row("40 MP, PNG of 16 bit and alpha", encode(".png", cv::Mat(5000, 8000, CV_16UC4, cv::Scalar::all(4e4))));
  intake_row("40 MP, JPEG", photograph_of_plan(8000, 5000));
  intake_row("40 MP, WebP", encode(".webp", plan_like(8000, 5000)));
  intake_row("40 MP and one row", encode(".png", cv::Mat(5001, 8000, CV_8UC1, cv::Scalar(255))));
}

}  // namespace

void print_hostile_files() {
  std::printf("intake: what each file costs (memory on top of the process's own), and what is said of it\n");
  print_odd_pictures();
  const PictureLimits hasty;
  std::printf("PDFs made to do harm; a page may take %.2f s of processor time and %zu MB\n", hasty.pdf_processor_s,
              hasty.pdf_bytes / 1'000'000);
  for (const auto& file : test::hostile_pdfs()) pdf_row(file);
  std::printf("PDFs that are much work\n");
  for (const auto& file : test::heavy_pdfs()) pdf_row(file);
  pdf_row({"500 pages, the last one", test::pdf::pages(500)}, {}, 499);
  pdf_row({"500 pages, page 501", test::pdf::pages(500)}, {}, 500);
  std::printf("the same with patience (%.0f s)\n", PictureLimits::patient().pdf_processor_s);
  for (const auto& file : test::heavy_pdfs()) pdf_row(file, PictureLimits::patient());
  std::printf("intake and reading\n");
  reading_row("12 MP photograph", 4000, 3000);
  reading_row("40 MP photograph", 8000, 5000);
}

}  // namespace smokemap::bench
