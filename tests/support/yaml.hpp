#pragma once

#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace smokemap::test {

/// As much of YAML as proto/http.yaml uses, as JSON: maps and lists by indentation, {flow: [style]}, quoted and plain
/// scalars, `>` texts. Numbers stay texts: nobody asks for them.
class YamlFile {
 public:
  static nlohmann::json read(const std::string& path) {
    std::ifstream file(path);
    YamlFile yaml;
    for (std::string line; std::getline(file, line);)
      if (const auto first = line.find_first_not_of(' '); first != std::string::npos && line[first] != '#')
        yaml.lines_.push_back({first, line.substr(first)});
    return yaml.block(0);
  }

 private:
  using json = nlohmann::json;
  struct Line {
    std::size_t indent;
    std::string text;
  };

  bool more(std::size_t indent) const { return at_ < lines_.size() && lines_[at_].indent >= indent; }

  json block(std::size_t indent) {
    if (!more(indent)) return nullptr;
    return lines_[at_].text.starts_with("- ") ? list(lines_[at_].indent) : map(lines_[at_].indent);
  }
  json list(std::size_t indent) {
    json items = json::array();
    while (more(indent) && lines_[at_].indent == indent && lines_[at_].text.starts_with("- ")) {
      Line& line = lines_[at_];
      const std::string item = line.text.substr(2);
      if (item.find(": ") == std::string::npos || item.front() == '{') {
        ++at_;
        items.push_back(value(item));
      } else {  // a map that begins beside the dash
        line = {indent + 2, item};
        items.push_back(map(indent + 2));
      }
    }
    return items;
  }
  json map(std::size_t indent) {
    json object = json::object();
    while (more(indent) && lines_[at_].indent == indent && !lines_[at_].text.starts_with("- ")) {
      std::istringstream text(lines_[at_++].text);
      std::string key = scalar(text, ":"), rest;
      text.get();  // the colon
      std::getline(text >> std::ws, rest);
      if (rest == ">")
        object[key] = folded(indent);
      else
        object[key] = rest.empty() ? block(indent + 1) : value(rest);
    }
    return object;
  }
  std::string folded(std::size_t indent) {
    std::string text;
    for (; more(indent + 1); ++at_) text += lines_[at_].text + " ";
    return text;
  }

  static json value(const std::string& text) {
    if (text.front() != '{' && text.front() != '[') {
      std::istringstream plain(text);
      return scalar(plain, "");
    }
    std::istringstream flow(text);
    return flow_value(flow);
  }
  static json flow_value(std::istringstream& in) {
    const int first = (in >> std::ws).peek();
    if (first != '{' && first != '[') return scalar(in, ",}]");
    const char end = first == '{' ? '}' : ']';
    json all = first == '{' ? json::object() : json::array();
    in.get();
    while ((in >> std::ws).peek() != end && in) {
      if (end == '}') {
        const std::string key = scalar(in, ":");
        in.get();
        all[key] = flow_value(in);
      } else {
        all.push_back(flow_value(in));
      }
      if ((in >> std::ws).peek() == ',') in.get();
    }
    in.get();
    return all;
  }
  /// Up to one of `ends`, which stays.
  static std::string scalar(std::istringstream& in, const std::string& ends) {
    std::string text;
    const int quote = (in >> std::ws).peek();
    if (quote == '"' || quote == '\'') {
      in.get();
      std::getline(in, text, static_cast<char>(quote));
      in >> std::ws;
      return text;
    }
    while (in.peek() != EOF && ends.find(static_cast<char>(in.peek())) == std::string::npos)
      text += static_cast<char>(in.get());
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
  }

  std::vector<Line> lines_;
  std::size_t at_ = 0;
};

}  // namespace smokemap::test
