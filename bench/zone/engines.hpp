#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "lines.hpp"

namespace bench {

/// What is asked of every engine: all points within `radius` of the lines, chords at most `chord_error` off the arcs.
struct Task {
  const Lines& lines;
  double radius;
  double chord_error;  ///< ignored by krepl, whose arcs are arcs
  unsigned threads;    ///< ignored by the others
};

/// What an engine made, to see that all answered the same question.
struct Outcome {
  std::size_t vertices = 0;  ///< of the result: pieces of boundary, or vertices of polygons
  std::size_t holes = 0;
  double area = 0;
};

/// One engine with its input in its own form; only run() is timed.
class Engine {
 public:
  virtual ~Engine() = default;
  /// The operation alone. False if it failed.
  virtual bool run() = 0;
  /// About the last successful run.
  virtual Outcome outcome() const = 0;
};

std::unique_ptr<Engine> make_krepl(const Task& task);
std::unique_ptr<Engine> make_geos(const Task& task);
std::unique_ptr<Engine> make_boost(const Task& task);
std::unique_ptr<Engine> make_clipper(const Task& task);

/// Chords of a full circle so that each is at most `chord_error` from its arc.
int chords_of_circle(double radius, double chord_error);

}  // namespace bench
