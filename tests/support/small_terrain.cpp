#include "support/small_terrain.hpp"

#include <cmath>
#include <limits>
#include <sstream>

namespace krepl::test {

namespace {

using Split = Terrain::Split;
constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr const char* split_names[] = {"rising", "falling", "shorter"};

bool splits_falling(const SmallTerrain& c, double sw, double se, double nw, double ne) {
  if (c.grid.split != Split::shorter) return c.grid.split == Split::falling;
  const double down = std::abs(se - nw), rise = std::abs(sw - ne);
  return !std::isnan(down) && (std::isnan(rise) || down < rise);
}

std::string number(double x) {
  std::ostringstream out;
  out.precision(17);
  out << x;
  return out.str();
}

}  // namespace

std::string text(const SmallTerrain& c) {
  std::ostringstream out;
  if (!c.is_grid) {
    out << "mesh radius " << number(c.radius) << '\n';
    for (const auto& t : c.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        out << (k > 0 ? "  " : "") << number(t[k].x) << ' ' << number(t[k].y) << ' ' << number(t[k].z);
      }
      out << '\n';
    }
    return out.str();
  }
  out << "grid " << c.grid.columns << ' ' << c.grid.rows << ' ' << split_names[int(c.grid.split)] << " radius "
      << number(c.radius) << '\n';
  for (std::size_t i = 0; i < c.heights.size(); ++i) {
    out << (std::isnan(c.heights[i]) ? "." : number(c.heights[i])) << ((i + 1) % c.grid.columns == 0 ? '\n' : ' ');
  }
  return out.str();
}

std::optional<SmallTerrain> parse_small_terrain(const std::string& text) {
  std::istringstream lines(text);
  std::string all, line;
  while (std::getline(lines, line)) {
    if (!line.starts_with('#')) all += line + '\n';
  }
  std::istringstream in(all);
  SmallTerrain c;
  std::string kind, word;
  in >> kind;
  if (kind == "mesh") {
    c.is_grid = false;
    if (!(in >> word >> c.radius) || word != "radius") return std::nullopt;
    SmallTerrain::Triangle t;
    const auto read = [&](Point3& p) { return bool(in >> p.x >> p.y >> p.z); };
    while (read(t[0])) {
      if (!read(t[1]) || !read(t[2])) return std::nullopt;
      c.triangles.push_back(t);
    }
    return c;
  }
  std::string split;
  if (kind != "grid" || !(in >> c.grid.columns >> c.grid.rows >> split >> word >> c.radius) || word != "radius")
    return std::nullopt;
  for (int s = 0; s < 3; ++s) {
    if (split == split_names[s]) c.grid.split = Split(s);
  }
  while (in >> word) c.heights.push_back(word == "." ? missing : std::strtod(word.c_str(), nullptr));
  if (c.heights.size() != c.grid.columns * c.grid.rows) return std::nullopt;
  return c;
}

std::vector<SmallTerrain::Triangle> triangles_of(const SmallTerrain& c) {
  if (!c.is_grid) return c.triangles;
  std::vector<SmallTerrain::Triangle> triangles;
  const auto at = [&](std::size_t i, std::size_t j) {
    return Point3{c.grid.first.x + double(i) * c.grid.cell_x, c.grid.first.y + double(j) * c.grid.cell_y,
                  c.heights[j * c.grid.columns + i]};
  };
  const auto add = [&](Point3 p, Point3 q, Point3 r) {
    if (!std::isnan(p.z) && !std::isnan(q.z) && !std::isnan(r.z)) triangles.push_back({p, q, r});
  };
  for (std::size_t j = 0; j + 1 < c.grid.rows; ++j) {
    for (std::size_t i = 0; i + 1 < c.grid.columns; ++i) {
      const Point3 sw = at(i, j), se = at(i + 1, j), nw = at(i, j + 1), ne = at(i + 1, j + 1);
      if (splits_falling(c, sw.z, se.z, nw.z, ne.z)) {
        add(sw, se, nw), add(se, ne, nw);
      } else {
        add(sw, se, ne), add(sw, ne, nw);
      }
    }
  }
  return triangles;
}

Result<std::shared_ptr<const Terrain>> terrain_of(const SmallTerrain& c) {
  const auto share = [](Result<Terrain> t) -> Result<std::shared_ptr<const Terrain>> {
    if (!t) return t.error();
    return std::make_shared<const Terrain>(std::move(*t));
  };
  if (c.is_grid) return share(Terrain::from_grid(c.grid, c.heights));
  std::vector<Point3> vertices;
  std::vector<std::array<Terrain::Index, 3>> triangles;
  for (const auto& t : c.triangles) {
    const auto n = Terrain::Index(vertices.size());
    vertices.insert(vertices.end(), t.begin(), t.end());
    triangles.push_back({n, n + 1, n + 2});
  }
  return share(Terrain::from_triangles(std::move(vertices), std::move(triangles)));
}

SmallTerrain as_mesh(const SmallTerrain& c) {
  SmallTerrain m;
  m.is_grid = false;
  m.triangles = triangles_of(c);
  m.radius = c.radius;
  return m;
}

}  // namespace krepl::test
