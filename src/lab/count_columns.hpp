#pragma once

#include "lab/report.hpp"
#include "terrain/surface_counts.hpp"

namespace krepl::lab {

/// How much there is of a surface, as columns that every table of surfaces has.
inline void append_count_names(Table& table) {
  table.columns.insert(table.columns.end(), {"vertices", "edges", "faces", "planes", "cylinders", "spheres", "seams",
                                             "valleys", "rims", "triple_contacts"});
}

inline void append_counts(std::vector<Table::Value>& row, const terrain::SurfaceCounts& c) {
  for (const std::size_t count :
       {c.vertices, c.edges, c.faces, c.planes, c.cylinders, c.spheres, c.seams, c.valleys, c.rims, c.triple_contacts})
    row.emplace_back(whole(count));
}

}  // namespace krepl::lab
