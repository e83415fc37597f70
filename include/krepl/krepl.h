/* krepl from C, and from any language that can call C: zones of networks and profiles of 2D terrains.
 *
 * C99, and C89 with <stdint.h>; C++ too. docs/c_interface.md says what stays the same from version to version.
 *
 * Handles. Each krepl_..._create, _build and _compute gives a handle that the caller ends with the _destroy of its kind
 * (NULL is ignored). A network, zone or profile never changes: any number of threads may read it at once, and it lives
 * on its own, whatever else is destroyed. A context or builder is for one thread at a time (but krepl_context_cancel).
 *
 * Errors. Functions that can fail return a krepl_status and take a context first, which keeps the message of the last
 * failure; NULL for the context means default settings and no message. A handle that was to be made is then NULL,
 * arrays are left as they were. Functions that only tell a number give 0 (size_t) or NaN (double) for a NULL handle.
 * Nothing is printed, nothing is thrown.
 *
 * Coordinates are doubles in the input's own unit, two for each point (x and y, or x and z). Not degrees.
 */
#ifndef KREPL_KREPL_H
#define KREPL_KREPL_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define KREPL_API __attribute__((visibility("default")))
#else
#define KREPL_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Versions ---- */

/* Of this header; krepl_version() tells that of the library. */
#define KREPL_VERSION_MAJOR 0
#define KREPL_VERSION_MINOR 1
#define KREPL_VERSION_PATCH 0
/* Goes up when a program compiled against an older header no longer runs with the library. */
#define KREPL_INTERFACE_VERSION 1

/* "0.1.0" */
KREPL_API const char* krepl_version(void);
/* KREPL_INTERFACE_VERSION of the library: use it only if it is the header's. */
KREPL_API int32_t krepl_interface_version(void);

/* ---- Errors ---- */

typedef int32_t krepl_status;
enum {
  KREPL_OK = 0,
  KREPL_ERROR_USAGE = 1,       /* a parameter is out of its range: a radius of zero, NULL for a handle */
  KREPL_ERROR_INPUT = 2,       /* the data cannot be taken as they are: nothing there, not a number */
  KREPL_ERROR_COMPUTATION = 3, /* a result could not be certified: nothing is returned rather than something broken */
  KREPL_ERROR_CANCELLED = 4,   /* the caller asked to stop */
  KREPL_ERROR_MEMORY = 5,      /* out of memory */
  KREPL_ERROR_INTERNAL = 6     /* a fault of krepl */
};

/* "a parameter is out of its range", ...: never NULL. */
KREPL_API const char* krepl_status_text(krepl_status status);

/* ---- Context: how computations run, and what went wrong ---- */

typedef struct krepl_context krepl_context;

/* NULL only if there is no memory. */
KREPL_API krepl_context* krepl_context_create(void);
KREPL_API void krepl_context_destroy(krepl_context* context);

/* Threads of a computation; 0 (the default) means all that the machine has. The result does not depend on it by a bit.
 */
KREPL_API krepl_status krepl_context_set_threads(krepl_context* context, uint32_t threads);

/* Called now and then during a computation with the fraction done, in [0,1], from any of its threads but never from two
 * at once, and `user` as it was given. A return value other than 0 cancels that computation. It must not use the
 * context. NULL for none. */
typedef int32_t (*krepl_progress)(double fraction, void* user);
KREPL_API krepl_status krepl_context_set_progress(krepl_context* context, krepl_progress progress, void* user);

/* From any thread, at any time: the running computation ends within a fraction of a second with KREPL_ERROR_CANCELLED,
 * and so does each later one until krepl_context_resume. */
KREPL_API void krepl_context_cancel(krepl_context* context);
KREPL_API void krepl_context_resume(krepl_context* context);

/* What the last failed call with this context says: what is wrong, where, what to do. "" before the first failure.
 * Valid until the next call with this context. UTF-8, no full stop at its end. */
KREPL_API const char* krepl_context_message(const krepl_context* context);

/* ---- Networks: lines, polygons and points, in any number and order ---- */

typedef struct krepl_builder krepl_builder;
typedef struct krepl_network krepl_network;

KREPL_API krepl_builder* krepl_builder_create(void);
KREPL_API void krepl_builder_destroy(krepl_builder* builder);

/* A polyline of `count` points, xy[2i] and xy[2i+1]; one point makes an isolated point, none is ignored. Lines may
 * cross, overlap, branch and repeat. `feature` is the caller's number and comes back in krepl_piece; -1 where there is
 * none. */
KREPL_API krepl_status krepl_builder_add_line(krepl_context* context, krepl_builder* builder, const double* xy,
                                              size_t count, int64_t feature);
/* A ring of a polygon, closed by the caller or not; rings of one feature count by the even-odd rule. */
KREPL_API krepl_status krepl_builder_add_ring(krepl_context* context, krepl_builder* builder, const double* xy,
                                              size_t count, int64_t feature);
KREPL_API krepl_status krepl_builder_add_point(krepl_context* context, krepl_builder* builder, double x, double y,
                                               int64_t feature);

/* Takes all that was added, well or not: the builder is empty afterwards and can be used again. Errors: no point at
 * all; a coordinate that is NaN or infinite (named by feature and vertex); more than 2^28 points. */
KREPL_API krepl_status krepl_network_build(krepl_context* context, krepl_builder* builder, krepl_network** network);
KREPL_API void krepl_network_destroy(krepl_network* network);

/* Distinct vertices, and distinct segments of positive length. */
KREPL_API size_t krepl_network_vertex_count(const krepl_network* network);
KREPL_API size_t krepl_network_segment_count(const krepl_network* network);

/* ---- Zones: network (+) disk, bounded by true segments and arcs ---- */

typedef struct krepl_zone krepl_zone;

/* Algorithms; all give the same zone. */
enum {
  KREPL_ENGINE_AUTO = 0,      /* chosen by the number of radii, and by how the input lies */
  KREPL_ENGINE_INTERVALS = 1, /* covered intervals of boundary elements (docs/zone.md) */
  KREPL_ENGINE_VORONOI = 2    /* out of the segment Voronoi diagram (docs/voronoi.md) */
};

/* Set `size` to sizeof(krepl_zone_options): members that later versions append are then absent, which means their
 * default. 0 is the default of every member but the radius. */
typedef struct krepl_zone_options {
  size_t size;
  double radius;  /* of the disk, in the unit of the coordinates: finite, positive, above their resolution */
  int32_t engine; /* KREPL_ENGINE_... */
  int32_t unused; /* 0 */
} krepl_zone_options;
#define KREPL_ZONE_OPTIONS(radius) \
  { sizeof(krepl_zone_options), (radius), KREPL_ENGINE_AUTO, 0 }

/* Expected O(n log n). Every vertex and curve point is within 1e-9 of the largest of radius and extent from the true
 * boundary. Errors: the options; the network is NULL; a result that cannot be certified; cancelled. */
KREPL_API krepl_status krepl_zone_compute(krepl_context* context, const krepl_network* network,
                                          const krepl_zone_options* options, krepl_zone** zone);
/* The zones at `count` radii, zones[i] at radii[i], from one pass where that pays; options->radius is not used. All of
 * them or none: after a failure all of zones[0 .. count-1] are NULL. */
KREPL_API krepl_status krepl_zone_compute_all(krepl_context* context, const krepl_network* network,
                                              const krepl_zone_options* options, const double* radii, size_t count,
                                              krepl_zone** zones);
KREPL_API void krepl_zone_destroy(krepl_zone* zone);

KREPL_API double krepl_zone_radius(const krepl_zone* zone);
KREPL_API double krepl_zone_area(const krepl_zone* zone);
KREPL_API double krepl_zone_perimeter(const krepl_zone* zone);
KREPL_API size_t krepl_zone_piece_count(const krepl_zone* zone);
KREPL_API size_t krepl_zone_ring_count(const krepl_zone* zone);
KREPL_API size_t krepl_zone_hole_count(const krepl_zone* zone);
/* Connected parts: each is one outer ring and its holes. */
KREPL_API size_t krepl_zone_polygon_count(const krepl_zone* zone);

enum { KREPL_SEGMENT = 0, KREPL_ARC = 1, KREPL_HALF_LINE = 2 };

/* A piece of the boundary. The zone is on its left. */
typedef struct krepl_piece {
  double start_x, start_y;
  double end_x, end_y;       /* the next piece of the ring starts there */
  double center_x, center_y; /* arcs: start == end is all the circle about it; NaN for segments */
  double radius;             /* arcs: that of the zone; NaN for segments */
  int64_t feature;           /* what causes it: the feature's number as the caller gave it, */
  uint32_t part;             /* the running number of the line, ring or point, */
  uint32_t vertex;           /* and the vertex of that part (for segments: the first of two) */
  int32_t kind;              /* KREPL_SEGMENT or KREPL_ARC */
  int32_t clockwise;         /* the sense of an arc; 0: counter-clockwise, as all are in this version */
} krepl_piece;

typedef struct krepl_ring {
  size_t first_piece, piece_count;
  size_t polygon;  /* which of the krepl_zone_polygon_count() it belongs to */
  int32_t is_hole; /* 0: outer ring, counter-clockwise; 1: hole, clockwise */
} krepl_ring;

/* Copies pieces [first, first + count) to `pieces`, element i at the address of pieces plus i * size; size is
 * sizeof(krepl_piece). Errors: beyond the last; NULL. */
KREPL_API krepl_status krepl_zone_pieces(krepl_context* context, const krepl_zone* zone, size_t first, size_t count,
                                         krepl_piece* pieces, size_t size);
/* The same for rings; size is sizeof(krepl_ring). */
KREPL_API krepl_status krepl_zone_rings(krepl_context* context, const krepl_zone* zone, size_t first, size_t count,
                                        krepl_ring* rings, size_t size);

/* KREPL_OK if rings close, arcs have the radius, and the topology is that of a subdivision; else KREPL_ERROR_INTERNAL
 * and a message that says where. O(pieces). */
KREPL_API krepl_status krepl_zone_check(krepl_context* context, const krepl_zone* zone);

/* ---- Profiles: 2D terrain (+) disk, from left to right ---- */

typedef struct krepl_profile krepl_profile;

/* The terrain is the polyline of the points (xz[2i], xz[2i+1]), x not decreasing, and everything below it. Linear time.
 * Errors: radius not in [1e-140, 1e140]; no point; x decreases, or a coordinate is not finite or above 1e140 (the
 * vertex is named); cancelled. */
KREPL_API krepl_status krepl_profile_compute(krepl_context* context, const double* xz, size_t count, double radius,
                                             krepl_profile** profile);
KREPL_API void krepl_profile_destroy(krepl_profile* profile);

KREPL_API double krepl_profile_radius(const krepl_profile* profile);
KREPL_API size_t krepl_profile_piece_count(const krepl_profile* profile);
/* Vertices where two pieces cross rather than join smoothly. */
KREPL_API size_t krepl_profile_explicit_vertex_count(const krepl_profile* profile);

typedef struct krepl_profile_piece {
  double start_x, start_z; /* -infinity for the lower end of a half-line */
  double end_x, end_z;
  double center_x, center_z; /* arcs: clockwise about it; NaN for others */
  uint32_t index; /* what causes it: the segment from vertex `index` to the next, or, for the others, the vertex */
  int32_t kind;   /* KREPL_SEGMENT, KREPL_ARC or KREPL_HALF_LINE */
} krepl_profile_piece;

/* As krepl_zone_pieces; size is sizeof(krepl_profile_piece). */
KREPL_API krepl_status krepl_profile_pieces(krepl_context* context, const krepl_profile* profile, size_t first,
                                            size_t count, krepl_profile_piece* pieces, size_t size);

#ifdef __cplusplus
}
#endif

#endif
