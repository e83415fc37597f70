#include "input/subdivision_file.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>

#include "input/json_scanner.hpp"

namespace krepl::input {

namespace {

using File = SubdivisionFile;

class SubdivisionReader {
 public:
  SubdivisionReader(std::FILE* file, const Context& context) : json_(file), context_(context) {}

  Result<File> read() {
    const bool read = json_.object([&](const std::string& key) { return value_of(key); }) && json_.end() && complete();
    if (read) return std::move(file_);
    if (context_.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    std::string where = json_.place();
    if (!list_.empty()) where = list_ + "[" + std::to_string(item_) + "], " + where;
    return Error{ErrorCode::input, json_.failure(), where, "give a subdivision that krepl terrain wrote as .json"};
  }

 private:
  bool value_of(const std::string& key) {
    seen_ += key + " ";
    std::string name;
    if (key == "krepl")
      return json_.string(name) && (name == "subdivision" || json_.fail("\"krepl\" is not \"subdivision\""));
    if (key == "version") {
      File::Index version = 0;
      return json_.index(version) && (version == 1 || json_.fail("this version of the format is not known"));
    }
    if (key == "radius") return json_.number(file_.radius);
    if (key == "features") return list("features", [&] { return feature(); });
    if (key == "vertices") return list("vertices", [&] { return point(file_.vertices); });
    if (key == "edges") return list("edges", [&] { return edge(); });
    if (key == "half_edges") return list("half_edges", [&] { return half_edge(); });
    if (key == "faces") return list("faces", [&] { return face(); });
    return json_.skip_value();
  }

  template <class F>
  bool list(const char* name, F&& each) {
    list_ = name, item_ = 0;
    const bool read = json_.array([&] {
      if (item_ % 4096 == 0 && context_.cancelled()) return json_.fail("cancelled");
      if (!each()) return false;
      ++item_;
      return true;
    });
    if (read) list_.clear();
    return read;
  }

  bool point(std::vector<Point3>& points) {
    double value[3];
    int count = 0;
    const bool read = json_.array([&] {
      if (count == 3) return json_.fail("a point of more than three numbers");
      return json_.number(value[count++]);
    });
    if (!read) return false;
    if (count != 3) return json_.fail("a point of fewer than three numbers");
    points.push_back({value[0], value[1], value[2]});
    return true;
  }

  bool index_or_null(File::Index& index) {
    if (json_.null()) return index = File::none, true;
    return json_.index(index) && (index != File::none || json_.fail("an index that is too large"));
  }

  template <class Kind>
  bool word(std::initializer_list<std::string_view> words, Kind& kind) {
    std::string text;
    if (!json_.string(text)) return false;
    int i = 0;
    for (const std::string_view w : words) {
      if (text == w) return kind = Kind(i), true;
      ++i;
    }
    return json_.fail("'" + text + "' is not known here");
  }

  bool feature() {
    int kind = -1;
    std::vector<Point3> at;
    const bool read = json_.object([&](const std::string& key) {
      if (key == "kind") return word({"vertex", "edge", "face"}, kind);
      if (key == "at") return json_.array([&] { return point(at); });
      return json_.skip_value();
    });
    if (!read) return false;
    if (kind < 0 || at.size() != std::size_t(kind) + 1)
      return json_.fail("a feature without kind or with a wrong number of points");
    File::Feature feature{{}, kind + 1};
    std::copy(at.begin(), at.end(), feature.at.begin());
    file_.features.push_back(feature);
    return true;
  }

  bool edge() {
    File::Edge edge{{}, {}, {File::none, File::none}, file_.points.size()};
    int kinds = 0, curves = 0, features = 0;
    const bool read = json_.object([&](const std::string& key) {
      if (key == "kind") return ++kinds, word({"seam", "valley", "rim"}, edge.kind);
      if (key == "curve") return ++curves, word({"line", "circle", "ellipse", "quartic"}, edge.curve);
      if (key == "points") return json_.array([&] { return point(file_.points); });
      if (key != "features") return json_.skip_value();
      return json_.array([&] {
        if (features == 2) return json_.fail("an edge of more than two features");
        return index_or_null(edge.feature[std::size_t(features++)]);
      });
    });
    if (!read) return false;
    if (kinds != 1 || curves != 1 || features != 2) return json_.fail("an edge without kind, curve or two features");
    if (file_.points.size() < edge.first + 3) return json_.fail("an edge with fewer than three points");
    file_.edges.push_back(edge);
    return true;
  }

  bool half_edge() {
    File::Index value[5];
    int count = 0;
    const bool read = json_.array([&] {
      if (count == 5) return json_.fail("a half-edge of more than five indices");
      return json_.index(value[count++]);
    });
    if (!read) return false;
    if (count != 5) return json_.fail("a half-edge of fewer than five indices");
    file_.half_edges.push_back({value[0], value[1], value[2], value[3], value[4]});
    return true;
  }

  bool face() {
    File::Face face{File::none, File::none, file_.inner.size()};
    int features = 0, outers = 0;
    const bool read = json_.object([&](const std::string& key) {
      if (key == "feature") return ++features, index_or_null(face.feature);
      if (key == "outer") return ++outers, index_or_null(face.outer);
      if (key != "inner") return json_.skip_value();
      return json_.array([&] {
        file_.inner.push_back(File::none);
        return json_.index(file_.inner.back());
      });
    });
    if (!read) return false;
    if (features != 1 || outers != 1) return json_.fail("a face without feature or outer");
    file_.faces.push_back(face);
    return true;
  }

  bool complete() {
    for (const char* key : {"krepl", "version", "radius", "features", "vertices", "edges", "half_edges", "faces"}) {
      const std::string word = std::string(key) + " ";
      const std::size_t first = (" " + seen_).find(" " + word);
      if (first == std::string::npos) return json_.fail(std::string("no \"") + key + "\"");
      if ((" " + seen_).find(" " + word, first + 1) != std::string::npos)
        return json_.fail(std::string("\"") + key + "\" twice");
    }
    return true;
  }

  JsonScanner json_;
  const Context& context_;
  File file_;
  std::string list_, seen_;
  std::size_t item_ = 0;
};

using FileHandle = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

FileHandle open_file(const std::string& path) { return {std::fopen(path.c_str(), "rb"), std::fclose}; }

}  // namespace

bool looks_like_subdivision(const std::string& path) {
  const FileHandle file = open_file(path);
  if (!file) return false;
  std::string head(4096, '\0');
  head.resize(std::fread(head.data(), 1, head.size(), file.get()));
  return head.find("\"krepl\"") != std::string::npos && head.find("\"subdivision\"") != std::string::npos;
}

Result<SubdivisionFile> read_subdivision(const std::string& path, const Context& context) {
  const FileHandle file = open_file(path);
  if (!file) return Error{ErrorCode::io, std::string("cannot be read: ") + std::strerror(errno), "", ""};
  return SubdivisionReader(file.get(), context).read();
}

}  // namespace krepl::input
