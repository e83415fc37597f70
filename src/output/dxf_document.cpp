#include "output/dxf_document.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

#include "output/zone_curves.hpp"

namespace krepl::output {

namespace {

constexpr int model_space_handle = 0x1F;
constexpr int paper_space_handle = 0x1B;
constexpr int root_dictionary_handle = 0xC;
constexpr int first_free_handle = 0x100;

/// Writes group code and value lines, and numbers the entities.
class DxfText {
 public:
  explicit DxfText(OutputStream& stream) : stream_(stream) {}

  template <class T>
  void group(int code, const T& value) {
    fmt::format_to(std::back_inserter(text_), "{:>3}\n{}\n", code, value);
  }
  void handle(int code, int value) { fmt::format_to(std::back_inserter(text_), "{:>3}\n{:X}\n", code, value); }
  int new_handle() { return next_handle_++; }
  void begin_section(const char* name) {
    group(0, "SECTION");
    group(2, name);
  }
  void end_section() {
    group(0, "ENDSEC");
    flush();
  }
  void flush() {
    stream_.write({text_.data(), text_.size()});
    text_.clear();
  }

 private:
  OutputStream& stream_;
  fmt::memory_buffer text_;
  int next_handle_ = first_free_handle;
};

void begin_table(DxfText& text, const char* name, int handle, std::size_t count) {
  text.group(0, "TABLE");
  text.group(2, name);
  text.handle(5, handle);
  text.handle(330, 0);
  text.group(100, "AcDbSymbolTable");
  text.group(70, count);
}

void begin_record(DxfText& text, const char* type, int handle, int owner, const char* subclass, std::string_view name) {
  text.group(0, type);
  text.handle(5, handle);
  text.handle(330, owner);
  text.group(100, "AcDbSymbolTableRecord");
  text.group(100, subclass);
  text.group(2, name);
}

void put_header(DxfText& text, int handle_seed) {
  text.begin_section("HEADER");
  text.group(9, "$ACADVER");
  text.group(1, "AC1015");
  text.group(9, "$DWGCODEPAGE");
  text.group(3, "ANSI_1252");
  text.group(9, "$HANDSEED");
  text.handle(5, handle_seed);
  text.group(9, "$MEASUREMENT");
  text.group(70, 1);
  text.end_section();
  text.begin_section("CLASSES");
  text.end_section();
}

void put_viewport_table(DxfText& text) {
  begin_table(text, "VPORT", 0x8, 0);
  text.group(0, "ENDTAB");
}

void put_line_types(DxfText& text) {
  begin_table(text, "LTYPE", 0x5, 3);
  int handle = 0x14;
  for (const char* name : {"ByBlock", "ByLayer", "Continuous"}) {
    begin_record(text, "LTYPE", handle++, 0x5, "AcDbLinetypeTableRecord", name);
    text.group(70, 0);
    text.group(3, "");
    text.group(72, 65);
    text.group(73, 0);
    text.group(40, "0.0");
  }
  text.group(0, "ENDTAB");
}

void put_layers(DxfText& text, const std::vector<std::string>& names) {
  begin_table(text, "LAYER", 0x2, names.size() + 1);
  auto put = [&](const std::string& name, int handle, int color) {
    begin_record(text, "LAYER", handle, 0x2, "AcDbLayerTableRecord", name);
    text.group(70, 0);
    text.group(62, color);
    text.group(6, "Continuous");
    text.handle(390, 0xF);
  };
  put("0", 0x10, 7);
  for (std::size_t i = 0; i < names.size(); ++i) put(names[i], text.new_handle(), 1 + static_cast<int>(i % 6));
  text.group(0, "ENDTAB");
}

void put_style_tables(DxfText& text) {
  begin_table(text, "STYLE", 0x3, 1);
  begin_record(text, "STYLE", 0x11, 0x3, "AcDbTextStyleTableRecord", "Standard");
  for (auto [code, value] :
       {std::pair{70, "0"}, {40, "0.0"}, {41, "1.0"}, {50, "0.0"}, {71, "0"}, {42, "2.5"}, {3, "txt"}, {4, ""}}) {
    text.group(code, value);
  }
  text.group(0, "ENDTAB");
  for (auto [name, handle] : {std::pair{"VIEW", 0x6}, {"UCS", 0x7}}) {
    begin_table(text, name, handle, 0);
    text.group(0, "ENDTAB");
  }
  begin_table(text, "APPID", 0x9, 1);
  begin_record(text, "APPID", 0x12, 0x9, "AcDbRegAppTableRecord", "ACAD");
  text.group(70, 0);
  text.group(0, "ENDTAB");
  begin_table(text, "DIMSTYLE", 0xA, 0);
  text.group(100, "AcDbDimStyleTable");
  text.group(0, "ENDTAB");
}

void put_block_records(DxfText& text) {
  begin_table(text, "BLOCK_RECORD", 0x1, 2);
  begin_record(text, "BLOCK_RECORD", model_space_handle, 0x1, "AcDbBlockTableRecord", "*Model_Space");
  begin_record(text, "BLOCK_RECORD", paper_space_handle, 0x1, "AcDbBlockTableRecord", "*Paper_Space");
  text.group(0, "ENDTAB");
}

void put_block(DxfText& text, const char* name, int owner, int handle) {
  text.group(0, "BLOCK");
  text.handle(5, handle);
  text.handle(330, owner);
  text.group(100, "AcDbEntity");
  text.group(8, "0");
  text.group(100, "AcDbBlockBegin");
  text.group(2, name);
  text.group(70, 0);
  for (int code : {10, 20, 30}) text.group(code, "0.0");
  text.group(3, name);
  text.group(1, "");
  text.group(0, "ENDBLK");
  text.handle(5, handle + 1);
  text.handle(330, owner);
  text.group(100, "AcDbEntity");
  text.group(8, "0");
  text.group(100, "AcDbBlockEnd");
}

void put_blocks(DxfText& text) {
  text.begin_section("BLOCKS");
  put_block(text, "*Model_Space", model_space_handle, 0x20);
  put_block(text, "*Paper_Space", paper_space_handle, 0x1C);
  text.end_section();
}

void begin_dictionary(DxfText& text, const char* type, int handle, int owner) {
  text.group(0, type);
  text.handle(5, handle);
  text.handle(330, owner);
  text.group(100, "AcDbDictionary");
  text.group(281, 1);
}

void put_objects(DxfText& text) {
  text.begin_section("OBJECTS");
  begin_dictionary(text, "DICTIONARY", root_dictionary_handle, 0);
  text.group(3, "ACAD_GROUP");
  text.handle(350, 0xD);
  text.group(3, "ACAD_PLOTSTYLENAME");
  text.handle(350, 0xE);
  begin_dictionary(text, "DICTIONARY", 0xD, root_dictionary_handle);
  begin_dictionary(text, "ACDBDICTIONARYWDFLT", 0xE, root_dictionary_handle);
  text.group(3, "Normal");
  text.handle(350, 0xF);
  text.group(100, "AcDbDictionaryWithDefault");
  text.handle(340, 0xF);
  text.group(0, "ACDBPLACEHOLDER");
  text.handle(5, 0xF);
  text.handle(330, 0xE);
  text.end_section();
  text.group(0, "EOF");
  text.flush();
}

}  // namespace

class DxfDocument::Text : public DxfText {
 public:
  using DxfText::DxfText;
};

DxfDocument::DxfDocument(OutputStream& stream, const std::vector<std::string>& layers, std::size_t polylines)
    : text_(std::make_unique<Text>(stream)) {
  put_header(*text_, first_free_handle + static_cast<int>(layers.size() + polylines) + 1);
  text_->begin_section("TABLES");
  put_viewport_table(*text_);
  put_line_types(*text_);
  put_layers(*text_, layers);
  put_style_tables(*text_);
  put_block_records(*text_);
  text_->end_section();
  put_blocks(*text_);
  text_->begin_section("ENTITIES");
}

DxfDocument::~DxfDocument() = default;

void DxfDocument::put(const std::vector<Vertex>& vertices, bool closed, const std::string& layer,
                      double elevation) {
  Text& text = *text_;
  text.group(0, "LWPOLYLINE");
  text.handle(5, text.new_handle());
  text.handle(330, model_space_handle);
  text.group(100, "AcDbEntity");
  text.group(8, layer);
  text.group(100, "AcDbPolyline");
  text.group(90, vertices.size());
  text.group(70, closed ? 1 : 0);
  if (elevation != 0) text.group(38, elevation);
  for (const Vertex& vertex : vertices) {
    text.group(10, vertex.at.x);
    text.group(20, vertex.at.y);
    if (vertex.bulge != 0) text.group(42, vertex.bulge);
  }
  text.flush();
}

void DxfDocument::finish() {
  text_->end_section();
  put_objects(*text_);
}

std::vector<DxfDocument::Vertex> DxfDocument::arc_vertices(const Zone::Piece& arc) {
  const std::vector<Point> ends = arc_ends(arc, std::numbers::pi);
  const double step = (arc.clockwise ? -1 : 1) * arc_angle(arc) / static_cast<double>(ends.size() - 1);
  std::vector<Vertex> vertices;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) vertices.push_back({ends[i], std::tan(step / 4)});
  return vertices;
}

}  // namespace krepl::output
