// Reading meshes: every format gives the same triangles, without loss of digits; damage is named.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <thread>

#include "input/mesh_reader.hpp"
#include "input/terrain_reader.hpp"
#include "support/environment.hpp"
#include "support/temporary_file.hpp"

namespace krepl::test {
namespace {

using input::MeshFormat;

Result<input::TriangleMesh> read(const std::string& text, MeshFormat format) { return input::read_mesh(text, format); }

std::string fault(const std::string& text, MeshFormat format) {
  const auto mesh = read(text, format);
  return mesh.ok() ? "read without error" : mesh.error().text();
}

template <class Number>
void append(std::string& bytes, Number value, bool big_endian = false) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (big_endian) std::reverse(raw, raw + sizeof value);
  bytes.append(raw, sizeof value);
}

std::string binary_stl(const std::vector<std::array<float, 9>>& triangles, const std::string& title = "binary") {
  std::string bytes = title;
  bytes.resize(80, '\0');
  append(bytes, std::uint32_t(triangles.size()));
  for (const auto& t : triangles) {
    for (int k = 0; k < 3; ++k) append(bytes, 0.0f);
    for (const float v : t) append(bytes, v);
    append(bytes, std::uint16_t{7});
  }
  return bytes;
}

/// Four corners of a square with UTM coordinates that single precision cannot hold, as two triangles.
const std::vector<Point3> square{{672345.12345678912, 3981234.987654321, 100.1},
                                 {672346.12345678912, 3981234.987654321, 100.2},
                                 {672346.12345678912, 3981235.987654321, 100.3},
                                 {672345.12345678912, 3981235.987654321, 100.4}};

std::string row(const Point3& p) {
  char text[120];
  std::snprintf(text, sizeof text, "%.17g %.17g %.17g", p.x, p.y, p.z);
  return text;
}

void expect_square(const Result<input::TriangleMesh>& mesh) {
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  EXPECT_TRUE(mesh->notes.empty());
  std::vector<std::array<Point3, 3>> triangles;
  for (const auto& t : mesh->triangles)
    triangles.push_back({mesh->vertices[t[0]], mesh->vertices[t[1]], mesh->vertices[t[2]]});
  const std::vector<std::array<Point3, 3>> want{{square[0], square[1], square[2]}, {square[0], square[2], square[3]}};
  EXPECT_EQ(triangles, want);
}

TEST(MeshReader, Off) {
  std::string vertices;
  for (const Point3& p : square) vertices += row(p) + "\n";
  expect_square(read("OFF\n4 2 5\n" + vertices + "3 0 1 2\n3 0 2 3\n", MeshFormat::off));
  expect_square(read("OFF 4 1\r\n# comment\r\n\r\n" + vertices + "4 0 1 2 3 0.1 0.2 0.3\n", MeshFormat::off));
  expect_square(read("4 1 0\n" + vertices + "4 0 1\n 2 3", MeshFormat::off));
  std::string coloured;
  for (const Point3& p : square) coloured += row(p) + " 0 0 1 255 255 0 255 # a corner\n";
  expect_square(read("CNOFF\n4 2 0\n" + coloured + "3 0 1 2\n3 0 2 3\n", MeshFormat::off));
}

TEST(MeshReader, Obj) {
  std::string vertices = "# made by hand\nmtllib none.mtl\no square\n";
  for (const Point3& p : square) vertices += "v " + row(p) + " 1.0\nvn 0 0 1\n";
  expect_square(read(vertices + "g a\nf 1 2 3\ng b\nusemtl x\nf 1 3 4\n", MeshFormat::obj));
  expect_square(read(vertices + "s off\nf 1/7/1 2//2 \\\n 3/1 \\\n -1\nl 1 2\np 1\n", MeshFormat::obj));
  expect_square(read(vertices + "f -4 -3 -2\nf -4 -2 -1", MeshFormat::obj));
}

TEST(MeshReader, PlyAsText) {
  std::string text =
      "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\nelement vertex 4\nproperty uchar red\nproperty double "
      "x\nproperty double y\n"
      "property double z\nelement edge 1\nproperty int a\nproperty int b\nelement face 2\nproperty list uchar int "
      "vertex_indices\n"
      "property float quality\nend_header\n";
  for (const Point3& p : square) text += "255 " + row(p) + "\n";
  expect_square(read(text + "0 1\n3 0 1 2 nan\n3 0 2 3 1.5\n", MeshFormat::ply));
}

TEST(MeshReader, PlyBinaryOfBothOrders) {
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\r\nelement vertex 4\r\nproperty float64 x\r\nproperty float64 y\r\nproperty list "
                        "uint8 int16 extra\r\nproperty "
                        "float64 z\r\nelement face 1\r\nproperty list uint16 uint32 vertex_index\r\nend_header\r\n";
    for (const Point3& p : square) {
      append(bytes, p.x, big), append(bytes, p.y, big), append(bytes, std::uint8_t{2});
      append(bytes, std::int16_t{-1}, big), append(bytes, std::int16_t{9}, big), append(bytes, p.z, big);
    }
    append(bytes, std::uint16_t{4}, big);
    for (const std::uint32_t v : {0u, 1u, 2u, 3u}) append(bytes, v, big);
    expect_square(read(bytes, MeshFormat::ply));
    bytes.resize(bytes.size() - 3);
    EXPECT_EQ(fault(bytes, MeshFormat::ply), "ends too early, face 0 of 1; the file seems to be cut off: get it again");
  }
}

TEST(MeshReader, PlyStrips) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement "
      "tristrips 1\n"
      "property list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 2 0\n8 0 1 2 3 -1 2 3 4\n";
  const auto mesh = read(text, MeshFormat::ply);
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  const std::vector<std::array<std::uint32_t, 3>> want{{0, 1, 2}, {1, 2, 3}, {2, 3, 4}};
  EXPECT_EQ(mesh->triangles, want);
}

TEST(MeshReader, StlAsText) {
  const auto facet = [](int a, int b, int c) {
    std::string text = "  facet normal 0 0 1\n outer loop\n";
    for (const int v : {a, b, c}) text += "  vertex " + row(square[std::size_t(v)]) + "\n";
    return text + " endloop\n endfacet\n";
  };
  expect_square(read("solid one\n" + facet(0, 1, 2) + facet(0, 2, 3) + "endsolid one\n", MeshFormat::stl));
  expect_square(
      read("SOLID\n" + facet(0, 1, 2) + "endsolid\nsolid solid\n" + facet(0, 2, 3) + "endsolid", MeshFormat::stl));
  EXPECT_EQ(fault("solid one\n" + facet(0, 1, 2), MeshFormat::stl),
            "ends before its endsolid, line 8; the file seems to be cut off: get it again");
}

TEST(MeshReader, StlBinary) {
  const std::string bytes =
      binary_stl({{0, 0, 0.1f, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 5, 0, 1, 0}}, "solid that is binary");
  const auto mesh = read(bytes, MeshFormat::stl);
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  EXPECT_EQ(mesh->triangles.size(), 2u);
  EXPECT_EQ(mesh->vertices[0], (Point3{0, 0, double(0.1f)}));
  EXPECT_EQ(mesh->vertices[4], (Point3{1, 1, 5}));
  EXPECT_EQ(fault(bytes.substr(0, 150), MeshFormat::stl),
            "ends after 1 of 2 triangles; the file seems to be cut off: get it again");
  EXPECT_EQ(fault(binary_stl({}), MeshFormat::stl), "has no triangles; give a mesh of triangles or polygons");
  EXPECT_EQ(fault(binary_stl({{0, 0, 0, 1, 0, NAN, 0, 1, 0}}), MeshFormat::stl),
            "a coordinate is not finite, triangle 0; repair the mesh");
}

TEST(MeshReader, ErrorsNameTheLine) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(fault(obj + "f 1 2 4\n", MeshFormat::obj),
            "a face has a vertex that does not exist, line 4; there are 3 vertices; correct the file");
  EXPECT_EQ(fault(obj + "f 0 1 2\n", MeshFormat::obj),
            "a face has corner 0, and vertices are counted from 1, line 4; correct the file");
  EXPECT_EQ(fault(obj + "f -4 1 2\n", MeshFormat::obj),
            "a face has a vertex that does not exist, line 4; correct the file");
  EXPECT_EQ(fault(obj, MeshFormat::obj), "has points but no triangles; give a mesh of triangles or polygons");
  EXPECT_EQ(fault("v 0 zero 0\n", MeshFormat::obj), "y 'zero' is not a number, line 1; correct the file");
  EXPECT_EQ(fault("v 0 0\n", MeshFormat::obj), "z is missing, line 1; correct the file");
  EXPECT_EQ(fault("\n\nv 0 nan 0\n", MeshFormat::obj), "y is not finite, line 3; correct the file");
  EXPECT_EQ(fault("v 0 1e999 0\n", MeshFormat::obj),
            "y '1e999' is out of the range of numbers, line 1; correct the file");
  EXPECT_EQ(fault("", MeshFormat::obj), "has no triangles; give a mesh of triangles or polygons");
  EXPECT_EQ(fault("OFF\n3 1 0\n0 0 0\n1 0 0\n", MeshFormat::off),
            "ends after 2 of 3 vertices, line 4; the file seems to be cut off: get it again");
  EXPECT_EQ(fault("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n", MeshFormat::off),
            "ends after 0 of 1 faces, line 5; the file seems to be cut off: get it again");
  EXPECT_EQ(fault("4OFF\n", MeshFormat::off),
            "'4OFF' is not read, its points are not in space, line 1; write it as OFF");
  EXPECT_EQ(fault("OFF BINARY\n", MeshFormat::off), "binary OFF is not read, line 1; write it as text");
  EXPECT_EQ(fault("solid x\n", MeshFormat::off),
            "'solid' instead of OFF, line 1; give a file in the format of its extension");
  EXPECT_EQ(fault("OFF\n99999999999 9 0\n", MeshFormat::off).substr(0, 10), "ends after");
  EXPECT_EQ(fault("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
                  MeshFormat::ply),
            "vertices have no z, header; give x, y and z");
  EXPECT_EQ(fault("ply\nelement vertex 1\nproperty quaternion x\n", MeshFormat::ply),
            "type 'quaternion' is unknown, line 3; correct the file");
  EXPECT_EQ(fault("ply\nformat ascii 1.0\n", MeshFormat::ply),
            "ends within its header, line 2; the file seems to be cut off: get it again");
  EXPECT_EQ(fault("OFF\n", MeshFormat::ply),
            "does not begin with ply, line 1; give a file in the format of its extension");
  EXPECT_EQ(fault("solid a\nvertex 0 0 0\n", MeshFormat::stl), "'vertex' is out of place, line 2; correct the file");
  EXPECT_EQ(fault("solid a\nfacet\nvertex 0 0 0\nendfacet\nendsolid\n", MeshFormat::stl),
            "a facet has not three vertices, line 4; correct the file");
}

TEST(MeshReader, DamagedFilesEndInAMeshOrAnError) {
  std::string
      square_off = "OFF\n4 2 5\n",
      ply =
          "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
          "property float y\nproperty float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Point3& p : square) {
    square_off += row(p) + "\n";
    for (const double v : {p.x, p.y, p.z}) append(ply, float(v));
  }
  square_off += "3 0 1 2\n3 0 2 3\n";
  for (int f = 0; f < 2; ++f) {
    append(ply, std::uint8_t{3});
    for (const std::int32_t v : {0, 1 + f, 2 + f}) append(ply, v);
  }
  const std::pair<std::string, MeshFormat> whole[] = {
      {square_off, MeshFormat::off},
      {ply, MeshFormat::ply},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 \\\n2\nf 1//2 2/1 3\nf -4 -3 -2 -1\n", MeshFormat::obj},
      {"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
       "0\nendloop\nendfacet\nendsolid\n",
       MeshFormat::stl},
      {binary_stl({{0, 0, 0.1f, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 5, 0, 1, 0}}), MeshFormat::stl}};
  std::mt19937_64 engine(seed());
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(engine); };
  const std::string signs = "0123456789-+./ \n\\#eEnaif";
  std::size_t read_anyway = 0;
  for (int run = 0; run < int(4000 * effort()); ++run) {
    for (const auto& [text, format] : whole) {
      std::string damaged = text;
      for (std::size_t i = 0, n = 1 + below(4); i < n; ++i) {
        const std::size_t at = below(damaged.size());
        switch (below(4)) {
          case 0:
            damaged[at] = signs[below(signs.size())];
            break;
          case 1:
            damaged[at] = char(below(256));
            break;
          case 2:
            damaged.erase(at, 1 + below(4));
            break;
          default:
            damaged.insert(at, 1, signs[below(signs.size())]);
        }
      }
      const auto mesh = read(damaged, format);
      if (!mesh) {
        ASSERT_FALSE(mesh.error().what.empty());
        continue;
      }
      ++read_anyway;
      for (const auto& t : mesh->triangles)
        for (const std::uint32_t v : t) ASSERT_LT(v, mesh->vertices.size());
      for (const Point3& p : mesh->vertices)
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
  }
  EXPECT_GT(read_anyway, 0u);
}

double doubled_area(const std::vector<Point3>& p, const std::array<std::uint32_t, 3>& t) {
  return (p[t[1]].x - p[t[0]].x) * (p[t[2]].y - p[t[0]].y) - (p[t[1]].y - p[t[0]].y) * (p[t[2]].x - p[t[0]].x);
}

/// Cuts a polygon of the plane z = x + 2y and sums the area of its triangles, none of which may be turned.
double covered_area(const std::vector<Point>& outline, bool expect_simple = true) {
  std::vector<Point3> vertices;
  std::vector<std::uint32_t> polygon;
  for (const Point p : outline) {
    polygon.push_back(std::uint32_t(vertices.size()));
    vertices.push_back({p.x, p.y, p.x + 2 * p.y});
  }
  std::vector<std::array<std::uint32_t, 3>> triangles;
  EXPECT_EQ(input::triangulate(vertices, polygon, triangles), expect_simple);
  EXPECT_EQ(triangles.size(), outline.size() - 2);
  double area = 0;
  for (const auto& t : triangles) {
    EXPECT_TRUE(!expect_simple || doubled_area(vertices, t) >= 0);
    area += doubled_area(vertices, t) / 2;
  }
  return area;
}

TEST(Triangulate, PolygonsAreCoveredOnce) {
  EXPECT_EQ(covered_area({{0, 0}, {4, 0}, {4, 3}, {0, 3}}), 12);
  EXPECT_EQ(covered_area({{0, 0}, {4, 0}, {1, 1}, {0, 4}}), 4);                   // a dart: corner 0 sees all
  EXPECT_EQ(covered_area({{1, 1}, {0, 4}, {0, 0}, {4, 0}}), 4);                   // the same from its notch
  EXPECT_EQ(covered_area({{4, 0}, {1, 1}, {0, 4}, {0, 0}}), 4);                   // and from where a fan would cross it
  EXPECT_EQ(covered_area({{0, 0}, {2, 0}, {4, 0}, {4, 4}, {2, 4}, {0, 4}}), 16);  // corners on straight sides
  EXPECT_EQ(
      covered_area({{0, 0}, {9, 0}, {9, 5}, {8, 5}, {8, 1}, {5, 1}, {5, 4}, {4, 4}, {4, 1}, {1, 1}, {1, 5}, {0, 5}}),
      20);  // a comb
  EXPECT_EQ(covered_area({{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}}),
            32);  // a hole on a bridge
}

TEST(Triangulate, CrossedPolygonsAreTold) {
  covered_area({{0, 0}, {3, 3}, {3, 0}, {0, 2}}, false);
  const auto mesh = read("OFF\n7 3 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n1 1 9\n3 1 0\n4 5 0\n5 0 2 1 4 3\n2 0 1\n4 0 1 1 0\n",
                         MeshFormat::off);
  ASSERT_TRUE(mesh.ok()) << mesh.error().text();
  EXPECT_EQ(mesh->notes.front(), "note: 2 faces with fewer than three corners left out");
}

TEST(Triangulate, FaceOfAWall) {
  std::vector<Point3> vertices{{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 2, 1}, {0, 0, 3}};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  EXPECT_TRUE(input::triangulate(vertices, std::vector<std::uint32_t>{4, 0, 1, 2, 3}, triangles));
  double area = 0;
  for (const auto& t : triangles) {
    const Point3 a = vertices[t[0]], b = vertices[t[1]], c = vertices[t[2]];
    const double doubled = (b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y);
    EXPECT_GT(doubled, 0);
    area += doubled / 2;
  }
  EXPECT_EQ(area, 8);
}

class TerrainFromMesh : public testing::Test {
 protected:
  std::string fault(const std::string& path, input::TerrainRequest request = {}) {
    request.path = path;
    const auto terrain = input::read_terrain(request);
    return terrain.ok() ? "read without error" : terrain.error().text();
  }
  TemporaryDirectory directory_;
  const std::string triangle_ = "OFF\n3 1 0\n0 0 1\n1 0 1\n0 1 2\n3 0 1 2\n";
};

TEST_F(TerrainFromMesh, HeightsAreScaledAndTheNameDecides) {
  input::TerrainRequest request;
  request.path = directory_.write("PART.Off", triangle_);
  request.z_scale = -2.5;
  request.crs = "EPSG:25832";
  const auto file = input::read_terrain(request);
  ASSERT_TRUE(file.ok()) << file.error().text();
  EXPECT_FALSE(file->terrain->is_grid());
  EXPECT_EQ(file->terrain->lowest().z + file->terrain->origin().z, -5);
  EXPECT_EQ(file->terrain->highest().z + file->terrain->origin().z, -2.5);
  EXPECT_EQ(file->crs_name, "ETRS89 / UTM zone 32N (EPSG:25832)");
}

TEST_F(TerrainFromMesh, APipeTellsByItsText) {
  for (const std::string& text :
       {triangle_, std::string("v 0 0 1\nv 1 0 1\nv 0 1 2\nf 1 2 3\n"),
        std::string("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -1\n1 2\n2 -1\n")}) {
    const std::string pipe = directory_ / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&] { std::ofstream(pipe) << text; });
    input::TerrainRequest request;
    request.path = pipe;
    const auto file = input::read_terrain(request);
    writer.join();
    std::filesystem::remove(pipe);
    ASSERT_TRUE(file.ok()) << file.error().text();
    EXPECT_EQ(file->terrain->triangle_count(), 1u);
  }
}

TEST_F(TerrainFromMesh, CompressedFiles) {
  const std::string plain = directory_.write("part.off", triangle_);
  ASSERT_EQ(std::system(("gzip -k " + plain).c_str()), 0);
  EXPECT_EQ(fault(plain + ".gz"), "read without error");
  std::filesystem::resize_file(plain + ".gz", 40);
  EXPECT_TRUE(fault(plain + ".gz").ends_with("the file seems to be damaged: get it again")) << fault(plain + ".gz");
}

TEST_F(TerrainFromMesh, TrianglesWithoutAreaAreCounted) {
  input::TerrainRequest request;
  request.path = directory_.write(
      "part.off", "OFF\n5 4 0\n0 0 1\n1 0 1\n0 1 2\n2 0 1\n0 0 1\n3 0 1 2\n3 0 1 3\n3 1 1 2\n3 2 4 1\n");
  const auto file = input::read_terrain(request);
  ASSERT_TRUE(file.ok()) << file.error().text();
  const Terrain::Report& report = file->terrain->report();
  EXPECT_EQ(report.triangles, 4u);
  EXPECT_EQ(report.zero_area_triangles, 2u);
  EXPECT_EQ(report.repeated_triangles, 1u);
  EXPECT_EQ(report.welded_vertices, 1u);
  EXPECT_EQ(file->terrain->triangle_count(), 1u);
}

TEST_F(TerrainFromMesh, BadFilesAndOptions) {
  EXPECT_EQ(fault(directory_ / "none.stl"), "no such file; check the name");
  EXPECT_EQ(fault(directory_.path().string()), "is a directory; name a file in it");
  EXPECT_EQ(fault(directory_.write("empty.obj", "")), "is empty");
  EXPECT_EQ(fault(directory_.write("flat.off", "OFF\n3 1 0\n0 0 1\n1 0 1\n2 0 1\n3 0 1 2\n")),
            "no triangle is left: all 1 have no area");
  const std::string good = directory_.write("good.off", triangle_);
  input::TerrainRequest request;
  request.split = Terrain::Split::falling;
  EXPECT_EQ(fault(good, request), "--split is for rasters, not for meshes; leave it out");
  request = {}, request.to_crs = "auto";
  EXPECT_EQ(fault(good, request), "--to-crs is for rasters, not for meshes; leave it out");
  request = {}, request.z_scale = 0;
  EXPECT_EQ(fault(good, request), "the factor of the heights is not a finite number other than zero");
  request = {}, request.crs = "EPSG:4326";
  EXPECT_EQ(fault(good, request),
            "coordinates are in degrees (WGS 84 (EPSG:4326)), not in a plane; project the mesh first");
}

}  // namespace
}  // namespace krepl::test
