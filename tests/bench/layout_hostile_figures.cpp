// Files that mean harm, or are odd, made here byte by byte, and what the intake says to each.
#include <sys/resource.h>

#include <cstdio>
#include <ctime>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "layout/read_layout.hpp"
#include "recording/picture_file.hpp"
#include "tests/bench/layout_figures.hpp"

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

/// Pages of an A4 with one line each; the content stream may be repeated to keep a renderer busy.
FileBytes pdf_of(int pages, int lines) {
  std::string kids, objects, content = "1 w ";
  for (int i = 0; i < lines; ++i) content += std::to_string(i % 600) + " 0 m 595 " + std::to_string(i % 842) + " l S ";
  for (int i = 0; i < pages; ++i) {
    kids += std::to_string(4 + i) + " 0 R ";
    objects += std::to_string(4 + i) + " 0 obj<</Type/Page/Parent 2 0 R/MediaBox[0 0 595 842]/Contents 3 0 R>>endobj\n";
  }
  return from_text("%PDF-1.4\n1 0 obj<</Type/Catalog/Pages 2 0 R>>endobj\n2 0 obj<</Type/Pages/Kids[" + kids +
                   "]/Count " + std::to_string(pages) + ">>endobj\n3 0 obj<</Length " + std::to_string(content.size()) +
                   ">>stream\n" + content + "\nendstream endobj\n" + objects + "trailer<</Root 1 0 R>>\n%%EOF\n");
}

cv::Mat plan_like(int width, int height) {
  cv::Mat picture(height, width, CV_8UC3, cv::Scalar(255, 255, 255));
  for (int i = 1; i < 8; ++i) {
    picture.rowRange(i * height / 8, i * height / 8 + 12).setTo(0);
    picture.colRange(i * width / 8, i * width / 8 + 12).setTo(0);
  }
  return picture;
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

void row(const char* name, const std::function<FileBytes()>& make, int page = 0) {
  const FileBytes bytes = make();
  const double begin = cpu_seconds(), wall = wall_seconds();
  const auto picture = decode_picture(bytes, {}, page);
  std::string answer = picture ? std::to_string(picture->cols) + " x " + std::to_string(picture->rows) + " px"
                               : "refused: " + picture.error().message;
  if (picture)
    for (const auto& warning : picture_warnings(bytes)) answer += "; " + warning;
  std::printf("  %-28s %8zu kB %6.2f cpu s %6.2f s %5ld MiB  %s\n", name, bytes.size() / 1000, cpu_seconds() - begin,
              wall_seconds() - wall, peak_mib(), answer.c_str());
}

}  // namespace

void print_hostile_files() {
  std::printf("intake (peak memory is of the whole run so far)\n");
  const cv::Mat plan = plan_like(1200, 900);
  row("empty file", [] { return FileBytes{}; });
  row("junk", [] { return FileBytes(200'000, 0xA5); });
  row("1 x 1", [] { return encode(".png", cv::Mat(1, 1, CV_8UC3, cv::Scalar(0, 0, 0))); });
  row("PNG that claims 30000 x 30000", [] { return png_that_claims(30000, 30000); });
  row("PNG that claims 6000 x 6000", [] { return png_that_claims(6000, 6000); });
  row("PNG of 36 MP, one colour", [] { return encode(".png", cv::Mat(6000, 6000, CV_8UC1, cv::Scalar(255))); });
  row("JPEG cut at two thirds", [&] {
    auto bytes = encode(".jpg", plan);
    bytes.resize(bytes.size() * 2 / 3);
    return bytes;
  });
  row("PNG cut in the middle", [&] {
    auto bytes = encode(".png", plan);
    bytes.resize(bytes.size() / 2);
    return bytes;
  });
  row("26 MB", [&] {
    auto bytes = encode(".png", plan);
    bytes.resize(26'000'000, 0);
    return bytes;
  });
  row("16 bit", [] { return encode(".png", cv::Mat(600, 800, CV_16UC3, cv::Scalar(30000, 40000, 50000))); });
  row("alpha", [] { return encode(".png", cv::Mat(600, 800, CV_8UC4, cv::Scalar(0, 0, 0, 100))); });
  row("TIFF", [] { return from_text(std::string("II*\0\x08\0\0\0", 8)); });
  row("PDF of 500 pages, page 1", [] { return pdf_of(500, 1); });
  row(
      "PDF of 500 pages, page 500", [] { return pdf_of(500, 1); }, 499);
  row(
      "PDF of 500 pages, page 501", [] { return pdf_of(500, 1); }, 500);
  row("PDF with 200 000 lines", [] { return pdf_of(1, 200'000); });
  row("12 MP photograph", [] { return encode(".jpg", plan_like(4000, 3000)); });
}

}  // namespace smokemap::bench
