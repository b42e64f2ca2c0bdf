#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "tests/support/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace smokemap::test {

/// The smokemap program, run in a folder of its own with files a person might give it.
class SmokemapFolder {
 public:
  Ran run(const std::vector<std::string>& arguments) const {
    return run_program(SMOKEMAP_PROGRAM, arguments, folder_.path());
  }
  std::string path(const std::string& name) const { return folder_.path() + "/" + name; }
  bool has(const std::string& name) const { return std::filesystem::exists(path(name)); }
  std::string text(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  /// A floor of two rooms with a door between them, as a map picture: free white, walls black, outside gray.
  /// @param shift  how far the wall between the rooms stands from its place, px
  void write_map(const std::string& name, int shift = 0) const {
    cv::Mat map(240, 320, CV_8UC1, cv::Scalar(205));
    map(cv::Rect(20, 20, 280, 200)).setTo(0);
    map(cv::Rect(26, 26, 120 + shift, 188)).setTo(255);
    map(cv::Rect(152 + shift, 26, 142 - shift, 188)).setTo(255);
    map(cv::Rect(140 + shift, 100, 20, 24)).setTo(255);
    ASSERT_TRUE(cv::imwrite(path(name), map));
  }
  /// Every file name there, sorted.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      all.push_back(entry.path().filename());
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  TemporaryFolder folder_;
};

inline const std::vector<std::string>& subcommands() {
  static const std::vector<std::string> names{"serve",  "segment", "match", "convert",  "robot",   "layout",
                                              "sketch", "merge",   "slam",  "simulate", "evaluate"};
  return names;
}

inline std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace smokemap::test
