// PLY, text and binary of either byte order: coordinates and corners of any number type; all other properties and
// elements are skipped.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "input/mesh_reader.hpp"
#include "input/text_scanner.hpp"

namespace krepl::input {

namespace {

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(Type type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[std::size_t(type)];
}

struct Property {
  std::string name;
  bool list = false;
  Type count = Type::uint8, type = Type::float32;
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  std::string format;
  std::vector<Element> elements;
};

Result<Type> type_named(const TextScanner& scanner, std::string_view name) {
  constexpr std::pair<std::string_view, Type> names[] = {
      {"char", Type::int8},   {"uchar", Type::uint8},   {"short", Type::int16},     {"ushort", Type::uint16},
      {"int", Type::int32},   {"uint", Type::uint32},   {"float", Type::float32},   {"double", Type::float64},
      {"int8", Type::int8},   {"uint8", Type::uint8},   {"int16", Type::int16},     {"uint16", Type::uint16},
      {"int32", Type::int32}, {"uint32", Type::uint32}, {"float32", Type::float32}, {"float64", Type::float64}};
  for (const auto& [known, type] : names)
    if (name == known) return type;
  return scanner.error("type " + quoted(name) + " is unknown");
}

Result<Property> read_property(TextScanner& scanner) {
  Property property;
  std::string_view word = scanner.word();
  if (word == "list") {
    property.list = true;
    const Result<Type> count = type_named(scanner, scanner.word());
    if (!count) return count.error();
    property.count = *count;
    word = scanner.word();
  }
  const Result<Type> type = type_named(scanner, word);
  if (!type) return type.error();
  property.type = *type;
  property.name = scanner.word();
  return property;
}

Result<Element> read_element(TextScanner& scanner) {
  Element element;
  element.name = scanner.word();
  const Result<std::int64_t> count = scanner.integer(scanner.word(), "the number of elements");
  if (!count) return count.error();
  if (*count < 0) return scanner.error("the number of elements is negative");
  element.count = *count;
  return element;
}

Result<Header> read_header(TextScanner& scanner) {
  if (!scanner.next() || scanner.word() != "ply")
    return scanner.error("does not begin with ply", "give a file in the format of its extension");
  Header header;
  while (scanner.next()) {
    const std::string_view keyword = scanner.word();
    if (keyword == "end_header") {
      if (header.format.empty()) return scanner.error("the header names no format");
      return header;
    }
    if (keyword == "format") {
      header.format = scanner.word();
    } else if (keyword == "element") {
      Result<Element> element = read_element(scanner);
      if (!element) return element.error();
      header.elements.push_back(std::move(*element));
    } else if (keyword == "property" && !header.elements.empty()) {
      Result<Property> property = read_property(scanner);
      if (!property) return property.error();
      header.elements.back().properties.push_back(std::move(*property));
    } else if (keyword != "comment" && keyword != "obj_info") {
      return scanner.error(quoted(keyword) + " is out of place in the header");
    }
  }
  return scanner.end_error("ends within its header");
}

/// The numbers after the header, one after the other.
class Values {
 public:
  virtual ~Values() = default;
  virtual Result<double> take(Type type, const char* what) = 0;
  virtual Status skip(Type type) = 0;
  /// What names the element that is being read in errors, and its number.
  virtual const char* place_name() const = 0;
  virtual std::uint64_t place(std::uint64_t element) const = 0;
};

class TextValues : public Values {
 public:
  explicit TextValues(TextScanner& scanner) : scanner_(scanner) {}
  Result<double> take(Type, const char* what) override {
    const std::string_view word = scanner_.flowing_word();
    if (word.empty()) return scanner_.end_error("ends too early");
    return scanner_.number(word, what);
  }
  Status skip(Type) override {
    if (scanner_.flowing_word().empty()) return scanner_.end_error("ends too early");
    return std::monostate{};
  }
  const char* place_name() const override { return "line"; }
  std::uint64_t place(std::uint64_t) const override { return scanner_.line(); }

 private:
  TextScanner& scanner_;
};

class BinaryValues : public Values {
 public:
  BinaryValues(std::string_view bytes, bool big_endian) : bytes_(bytes), reversed_(big_endian) {}
  Result<double> take(Type type, const char* what) override {
    char raw[8];
    const std::size_t size = size_of(type);
    if (bytes_.size() < size) return end_error();
    std::memcpy(raw, bytes_.data(), size);
    if (reversed_ == (std::endian::native == std::endian::little)) std::reverse(raw, raw + size);
    bytes_.remove_prefix(size);
    const double value = decoded(raw, type);
    if (!std::isfinite(value))
      return Error{ErrorCode::input, std::string(what) + " is not finite", "", "repair the mesh"};
    return value;
  }
  Status skip(Type type) override {
    if (bytes_.size() < size_of(type)) return end_error();
    bytes_.remove_prefix(size_of(type));
    return std::monostate{};
  }
  const char* place_name() const override { return "face"; }
  std::uint64_t place(std::uint64_t element) const override { return element; }

 private:
  template <class Number>
  static double as(const char* raw) {
    Number number;
    std::memcpy(&number, raw, sizeof number);
    return double(number);
  }
  static double decoded(const char* raw, Type type) {
    switch (type) {
      case Type::int8:
        return as<std::int8_t>(raw);
      case Type::uint8:
        return as<std::uint8_t>(raw);
      case Type::int16:
        return as<std::int16_t>(raw);
      case Type::uint16:
        return as<std::uint16_t>(raw);
      case Type::int32:
        return as<std::int32_t>(raw);
      case Type::uint32:
        return as<std::uint32_t>(raw);
      case Type::float32:
        return as<float>(raw);
      case Type::float64:
        break;
    }
    return as<double>(raw);
  }
  static Error end_error() {
    return {ErrorCode::input, "ends too early", "", "the file seems to be cut off: get it again"};
  }

  std::string_view bytes_;
  bool reversed_;
};

class BodyReader {
 public:
  BodyReader(Values& values, PolygonMesh& mesh, const Context& context)
      : values_(values), mesh_(mesh), context_(context) {
    mesh_.place_name = values.place_name();
  }

  Status read(const Element& element) {
    if (element.properties.empty()) return std::monostate{};
    for (std::int64_t i = 0; i < element.count; ++i) {
      if (i % 65536 == 0 && context_.cancelled())
        return Error{ErrorCode::cancelled, "interrupted while reading", "", ""};
      const Status status = element.name == "vertex" ? read_vertex(element) : read_other(element, i);
      if (status) continue;
      Error error = status.error();
      if (error.where.empty())
        error.where = element.name + " " + std::to_string(i) + " of " + std::to_string(element.count);
      return error;
    }
    return std::monostate{};
  }

 private:
  Status read_vertex(const Element& element) {
    Point3 p;
    for (const Property& property : element.properties) {
      double* coordinate = property.name == "x"   ? &p.x
                           : property.name == "y" ? &p.y
                           : property.name == "z" ? &p.z
                                                  : nullptr;
      if (coordinate == nullptr || property.list) {
        if (Status skipped = skip(property); !skipped) return skipped;
        continue;
      }
      const Result<double> value = values_.take(property.type, property.name.c_str());
      if (!value) return value.error();
      *coordinate = *value;
    }
    mesh_.vertices.push_back(p);
    return std::monostate{};
  }

  Status read_other(const Element& element, std::int64_t number) {
    const bool strips = element.name == "tristrips";
    for (const Property& property : element.properties) {
      const bool corners = property.list && (property.name == "vertex_indices" || property.name == "vertex_index");
      const Status status =
          corners && (strips || element.name == "face") ? read_corners(property, strips, number) : skip(property);
      if (!status) return status;
    }
    return std::monostate{};
  }

  Result<std::int64_t> take_count(const Property& property) {
    const Result<double> count = values_.take(property.count, "the length of a list");
    if (!count) return count.error();
    return whole(*count, "the length of a list", 0);
  }

  static Result<std::int64_t> whole(double value, const char* what, double least) {
    if (!(value >= least) || !(value < 0x1p53) || value != std::floor(value)) {
      return Error{ErrorCode::input, std::string(what) + " is not a number of that kind", "", "correct the file"};
    }
    return std::int64_t(value);
  }

  Status skip(const Property& property) {
    if (!property.list) return values_.skip(property.type);
    const Result<std::int64_t> count = take_count(property);
    if (!count) return count.error();
    for (std::int64_t k = 0; k < *count; ++k)
      if (Status skipped = values_.skip(property.type); !skipped) return skipped;
    return std::monostate{};
  }

  Status read_corners(const Property& property, bool strip, std::int64_t number) {
    const Result<std::int64_t> count = take_count(property);
    if (!count) return count.error();
    const std::uint64_t place = values_.place(std::uint64_t(number));
    std::int64_t last[2] = {-1, -1};
    for (std::int64_t k = 0; k < *count; ++k) {
      const Result<double> value = values_.take(property.type, "a corner");
      if (!value) return value.error();
      const Result<std::int64_t> v = whole(*value, "a corner", strip ? -1 : -0x1p53);
      if (!v) return v.error();
      if (!strip) {
        mesh_.corners.push_back(*v);
        continue;
      }
      if (*v >= 0 && last[0] >= 0) {  // -1 starts another strip
        mesh_.corners.insert(mesh_.corners.end(), {last[0], last[1], *v});
        mesh_.close_polygon(place);
      }
      last[0] = *v < 0 ? -1 : last[1];
      last[1] = *v;
    }
    if (!strip) mesh_.close_polygon(place);
    return std::monostate{};
  }

  Values& values_;
  PolygonMesh& mesh_;
  const Context& context_;
};

Status check_header(const Header& header) {
  for (const Element& element : header.elements) {
    if (element.name != "vertex") continue;
    for (const char* name : {"x", "y", "z"}) {
      const bool found = std::any_of(element.properties.begin(), element.properties.end(),
                                     [&](const Property& p) { return p.name == name && !p.list; });
      if (!found) return Error{ErrorCode::input, std::string("vertices have no ") + name, "header", "give x, y and z"};
    }
  }
  return std::monostate{};
}

}  // namespace

Result<PolygonMesh> read_ply(std::string_view text, const Context& context) {
  TextScanner scanner(text, {}, context);
  const Result<Header> header = read_header(scanner);
  if (!header) return header.error();
  if (Status checked = check_header(*header); !checked) return checked.error();
  std::unique_ptr<Values> values;
  const std::string& format = header->format;
  if (format == "ascii")
    values = std::make_unique<TextValues>(scanner);
  else if (format == "binary_little_endian" || format == "binary_big_endian")
    values = std::make_unique<BinaryValues>(text.substr(std::min(scanner.position(), text.size())),
                                            format == "binary_big_endian");
  else
    return Error{ErrorCode::input, "PLY format " + quoted(format) + " is unknown", "header", ""};
  PolygonMesh mesh;
  BodyReader body(*values, mesh, context);
  for (const Element& element : header->elements)
    if (Status read = body.read(element); !read) return read.error();
  return mesh;
}

}  // namespace krepl::input
