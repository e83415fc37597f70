#pragma once

#include <string_view>

#include "input/polygon_mesh.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"

namespace krepl::input {

/// Meshes: STL (text and binary), OBJ, PLY (text and binary), OFF. All parts of a file are united, every coordinate is
/// the double nearest to what the file says, nothing is merged or dropped, and polygons are cut into triangles.
///
/// These are readers of our own because Debian builds assimp with coordinates in single precision, which moves points
/// of text files and of PLY's doubles by 1e-7 of their size: centimetres in UTM coordinates.
///
/// Errors name the line (text) or the triangle, vertex or face (binary): no triangles; numbers missing, not finite or
/// not numbers; a corner that is no vertex; a file that ends early; a variant that is not read.
enum class MeshFormat { off, obj, ply, stl };
Result<TriangleMesh> read_mesh(std::string_view text, MeshFormat format, const Context& context = {});

/// The parts of read_mesh, each for one format.
Result<PolygonMesh> read_off(std::string_view text, const Context& context);
Result<PolygonMesh> read_obj(std::string_view text, const Context& context);
Result<PolygonMesh> read_ply(std::string_view text, const Context& context);
Result<PolygonMesh> read_stl(std::string_view text, const Context& context);

}  // namespace krepl::input
