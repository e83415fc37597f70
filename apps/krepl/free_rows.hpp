#pragma once

#include <string>
#include <vector>

#include "krepl/free_components.hpp"
#include "krepl/free_space.hpp"

namespace krepl::app {

/// Placements of a disk in the plane, and their rows.
struct DiskRows {
  using Space = DiskFreeSpace;
  using Place = Point;
  static constexpr bool with_z = false;
  static constexpr const char* place_columns = "x,y";
  static constexpr const char* contact_columns = "kind,px,py,feature";

  const Space& space;
  const FreeComponents* parts = nullptr;  ///< if they are asked for
  std::vector<std::uint32_t> found = {};  ///< components of a portion of placements

  static Place place(Point3 p) { return {p.x, p.y}; }
  void append_place(std::string& text, Place p) const;
  void append_contact(std::string& text, const Space::Contact& contact) const;
  bool components() const { return parts != nullptr; }
  Status find_components(const std::vector<Place>& places, const Context& context);
  void append_component(std::string& text, std::size_t i) const;
};

/// Placements of a ball in space.
struct BallRows {
  using Space = BallFreeSpace;
  using Place = Point3;
  static constexpr bool with_z = true;
  static constexpr const char* place_columns = "x,y,z";
  static constexpr const char* contact_columns = "kind,px,py,pz";

  const Space& space;
  static Place place(Point3 p) { return p; }
  void append_place(std::string& text, Place p) const;
  void append_contact(std::string& text, const Space::Contact& contact) const;
  bool components() const { return false; }
  Status find_components(const std::vector<Place>&, const Context&) { return std::monostate{}; }
  void append_component(std::string&, std::size_t) const {}
};

}  // namespace krepl::app
