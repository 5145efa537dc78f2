// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/prepare.hpp"

#include "host_tools/mesh/detail/prepare_steps.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus
{

namespace
{

using Point = std::array<double, 3>;

struct Box
{
    Point low{};
    Point high{};

    [[nodiscard]] double extent(std::size_t axis) const { return high[axis] - low[axis]; }
    [[nodiscard]] double largest_extent() const
    {
        return std::max({extent(0), extent(1), extent(2)});
    }
    /// Diagonal, computed after scaling by the largest extent: squares of tiny or huge lengths
    /// would under- or overflow.
    [[nodiscard]] double diagonal() const
    {
        const double largest = largest_extent();
        if (largest == 0.0 || !std::isfinite(largest))
        {
            return largest;
        }
        const double x = extent(0) / largest;
        const double y = extent(1) / largest;
        const double z = extent(2) / largest;
        return largest * std::sqrt(x * x + y * y + z * z);
    }
};

Box box_of(const std::vector<Point>& positions)
{
    Box box{positions.front(), positions.front()};
    for (const Point& p : positions)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            box.low[axis] = std::min(box.low[axis], p[axis]);
            box.high[axis] = std::max(box.high[axis], p[axis]);
        }
    }
    return box;
}

std::optional<Refusal> find_bad_option(const PrepareOptions& options)
{
    if (!(options.metres_per_unit > 0.0) || !std::isfinite(options.metres_per_unit))
    {
        return Refusal{fmt::format("metres per unit is {}; must be positive and finite",
                                   options.metres_per_unit)};
    }
    if (options.fit_diagonal_m &&
        !(*options.fit_diagonal_m >= kMinDiagonal_m && *options.fit_diagonal_m <= kMaxDiagonal_m))
    {
        return Refusal{fmt::format("fit diagonal is {} m; must be {} .. {} m",
                                   *options.fit_diagonal_m, kMinDiagonal_m, kMaxDiagonal_m)};
    }
    if (options.position_bits < kMinPositionBits || options.position_bits > kMaxPositionBits)
    {
        return Refusal{fmt::format("position bits is {}; must be {} .. {}", options.position_bits,
                                   kMinPositionBits, kMaxPositionBits)};
    }
    if (options.quantum_max_m && !(*options.quantum_max_m > 0.0))
    {
        return Refusal{fmt::format("the largest step of the grid is {} m; must be positive",
                                   *options.quantum_max_m)};
    }
    return std::nullopt;
}

std::optional<Refusal> find_bad_source(const TriangleMesh& source)
{
    for (std::size_t f = 0; f < source.faces.size(); ++f)
    {
        for (const std::uint32_t v : source.faces[f])
        {
            if (v >= source.positions.size())
            {
                return Refusal{fmt::format("face {} names vertex {}; must be below {}", f, v,
                                           source.positions.size())};
            }
            const Point& p = source.positions[v];
            if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
            {
                return Refusal{
                    fmt::format("vertex {} is ({}, {}, {}); must be finite", v, p[0], p[1], p[2])};
            }
        }
    }
    return std::nullopt;
}

TriangleMesh clean_up(TriangleMesh mesh, PreparedMesh& out)
{
    const std::size_t welded = detail::weld_equal_positions(mesh);
    out.welded_vertices += welded;
    out.degenerate_faces += detail::drop_degenerate_faces(mesh.faces);
    out.duplicate_faces += detail::drop_duplicate_faces(mesh.faces);
    // Vertices that became unused by welding do not count as isolated in the source.
    out.isolated_vertices += detail::drop_isolated_vertices(mesh) - welded;
    return mesh;
}

/// Translation from the source's frame, scaled, to the model's.
Point move_of(const Box& box, double scale, const PrepareOptions& options)
{
    Point moved_m{};
    for (std::size_t axis = 0; axis < 3 && options.is_centered; ++axis)
    {
        moved_m[axis] = -0.5 * (box.low[axis] * scale + box.high[axis] * scale);
    }
    return moved_m;
}

/// Sets scale, diagonal and origin of `out`; refuses values out of range.
std::optional<Refusal> choose_scale(const Box& box, const PrepareOptions& options,
                                    PreparedMesh& out)
{
    const double source_diagonal = box.diagonal();
    double scale = options.metres_per_unit;
    out.diagonal_m = source_diagonal * scale;
    if (options.fit_diagonal_m)
    {
        scale = *options.fit_diagonal_m / source_diagonal;
        out.diagonal_m = *options.fit_diagonal_m;
    }
    out.metres_per_unit = scale;
    const Point moved_m = move_of(box, scale, options);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        out.origin_m[axis] = box.low[axis] * scale + moved_m[axis];
        // The translation must also be finite in steps; a metre has fewer than 2^64.
        if (!std::isfinite(out.origin_m[axis]) || !std::isfinite(box.extent(axis) * scale) ||
            !std::isfinite(std::ldexp(moved_m[axis], 64)))
        {
            return Refusal{
                fmt::format("coordinates are no longer finite after scaling by {}", scale)};
        }
    }
    if (options.is_centered)
    {
        out.notes.push_back(fmt::format("moved by {:.9g}, {:.9g}, {:.9g} m to the origin",
                                        moved_m[0], moved_m[1], moved_m[2]));
    }
    if (!(out.diagonal_m >= kMinDiagonal_m && out.diagonal_m <= kMaxDiagonal_m))
    {
        return Refusal{fmt::format("the model's diagonal is {} m; must be {} .. {} m (check the "
                                   "unit, or fit it to a diagonal)",
                                   out.diagonal_m, kMinDiagonal_m, kMaxDiagonal_m)};
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        // Upper limit of all grid positions.
        const double far_m = out.origin_m[axis] + out.diagonal_m;
        if (out.origin_m[axis] < -kModelReachMax_m || far_m > kModelReachMax_m)
        {
            return Refusal{fmt::format("the model lies at {} m on an axis; at most {} m from the "
                                       "origin are supported: --center moves the model there",
                                       out.origin_m[axis], kModelReachMax_m)};
        }
    }
    return std::nullopt;
}

/// Divisor of the step for stitching: a vertex nearer to an edge than step / kStepsOnEdge lies on
/// the edge.
constexpr double kStepsOnEdge = 16.0;
/// Divisor of the step for joining border vertices: float or decimal sources may store the sides of
/// a common border up to step / kStepsApart apart.
constexpr double kStepsApart = 2.0;

/// Step of the grid: the least power of two of which 2^bits - 1 - kept steps cover the extent.
double choose_quantum(double extent_m, unsigned bits, double kept)
{
    const double steps = std::ldexp(1.0, static_cast<int>(bits)) - 1.0 - kept;
    double quantum = std::ldexp(1.0, std::ilogb(extent_m / steps));
    while (quantum * steps < extent_m)
    {
        quantum *= 2.0;
    }
    while (quantum * 0.5 * steps >= extent_m)
    {
        quantum *= 0.5;
    }
    return quantum;
}

/// Chooses the bits: the requested number, or more if the mesh or the caller needs a finer grid.
void choose_grid(const TriangleMesh& mesh, double extent_m, const PrepareOptions& options,
                 PreparedMesh& out)
{
    // With a given grid place, both ends of the mesh are rounded, so it may need one more step.
    const double kept = options.grid_place_m ? 1.0 : 0.0;
    double wanted_m = options.quantum_max_m.value_or(std::numeric_limits<double>::infinity());
    const char* why = "adjacent models have that grid";
    if (options.adds_bits)
    {
        const detail::GridNeed need = detail::measure_grid_need(mesh);
        const double for_mesh_m = std::min(need.for_edges, need.for_relief) * out.metres_per_unit;
        if (for_mesh_m < wanted_m)
        {
            wanted_m = for_mesh_m;
            why = need.for_edges < need.for_relief ? "for its short edges" : "for its fine relief";
        }
    }
    const double usual_m = choose_quantum(extent_m, options.position_bits, kept);
    out.position_bits = options.position_bits;
    out.quantum_m = usual_m;
    while (out.quantum_m > wanted_m && out.position_bits < kMaxPositionBits)
    {
        out.quantum_m = choose_quantum(extent_m, ++out.position_bits, kept);
    }
    if (out.position_bits > options.position_bits)
    {
        out.notes.push_back(fmt::format(
            "{} bits a coordinate instead of {}, steps of {:.3g} m instead of {:.3g} m: {}{}",
            out.position_bits, options.position_bits, out.quantum_m, usual_m, why,
            out.quantum_m > wanted_m ? fmt::format("; steps of {:.3g} m would be needed", wanted_m)
                                     : ""));
    }
}

/// Rounds positions to the grid. Without a grid place, distances are taken from the box's least
/// corner before scaling: far from the origin that difference is exact, though the coordinates have
/// few digits left. With a grid place they are taken after scaling, so that equal positions of
/// several meshes are rounded alike.
void put_on_grid(const TriangleMesh& mesh, const Box& box, const PrepareOptions& options,
                 PreparedMesh& out)
{
    const double scale = out.metres_per_unit;
    const Point moved_m = move_of(box, scale, options);
    std::array<double, 3> first{}; // First grid position of the mesh, in steps from grid_place_m.
    const auto steps = [&](double value, std::size_t axis)
    {
        return options.grid_place_m
                   ? (value * scale - (*options.grid_place_m)[axis]) / out.quantum_m
                   : (value - box.low[axis]) * scale / out.quantum_m;
    };
    for (std::size_t axis = 0; axis < 3 && options.grid_place_m; ++axis)
    {
        first[axis] = std::floor(steps(box.low[axis], axis) + 0.5);
        out.origin_m[axis] =
            (*options.grid_place_m)[axis] + first[axis] * out.quantum_m + moved_m[axis];
    }
    double worst = 0.0;
    out.mesh.positions.reserve(mesh.positions.size());
    for (const Point& p : mesh.positions)
    {
        std::array<std::int32_t, 3> place{};
        double off = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double quanta = steps(p[axis], axis);
            const double nearest = std::floor(quanta + 0.5);
            off += (quanta - nearest) * (quanta - nearest);
            place[axis] = static_cast<std::int32_t>(nearest - first[axis]);
        }
        worst = std::max(worst, off);
        out.mesh.positions.push_back(place);
    }
    out.quantisation_m += std::max(std::sqrt(worst) * out.quantum_m, options.moved_m);
}

void make_manifold(TriangleMesh& mesh, PreparedMesh& out)
{
    auto& positions = mesh.positions;
    const auto split =
        detail::split_into_manifold(mesh.faces, static_cast<std::uint32_t>(positions.size()));
    positions.reserve(positions.size() + split.copy_of.size());
    for (const std::uint32_t vertex : split.copy_of)
    {
        positions.push_back(positions[vertex]);
    }
    out.cut_edges = split.cut_edges;
    out.added_vertices = split.copy_of.size();
}

/// True if the corners are collinear. Products of differences of at most 24 bits fit in 64 bits.
bool is_flat(const QuantisedMesh& mesh, const std::array<std::uint32_t, 3>& face)
{
    const auto& a = mesh.positions[face[0]];
    std::array<std::int64_t, 3> ab{};
    std::array<std::int64_t, 3> ac{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        ab[axis] = mesh.positions[face[1]][axis] - a[axis];
        ac[axis] = mesh.positions[face[2]][axis] - a[axis];
    }
    return ab[1] * ac[2] == ab[2] * ac[1] && ab[2] * ac[0] == ab[0] * ac[2] &&
           ab[0] * ac[1] == ab[1] * ac[0];
}

void write_notes(PreparedMesh& out)
{
    const auto note = [&out](std::size_t count, std::string_view one, std::string_view many,
                             std::string_view what)
    {
        if (count > 0)
        {
            out.notes.push_back(fmt::format("{} {}", counted(count, one, many), what));
        }
    };
    const auto note_vertices = [&](std::size_t count, std::string_view what)
    { note(count, "vertex", "vertices", what); };
    const auto note_pieces = [&](std::size_t count, std::string_view what)
    { note(count, "closed piece", "closed pieces", what); };
    note_vertices(out.welded_vertices, "welded to another with the same position");
    note_vertices(out.isolated_vertices, "without a face dropped");
    note(out.degenerate_faces, "degenerate face", "degenerate faces",
         "dropped (two corners in one place)");
    note(out.duplicate_faces, "duplicate face", "duplicate faces", "dropped");
    note(out.cut_edges, "edge", "edges",
         "cut open (more than two faces, or two with the same direction)");
    note_vertices(out.added_vertices, "added where several fans of faces met");
    note_vertices(out.joined_vertices,
                  "of borders joined to others less than half a grid step away");
    note(out.stitched_faces, "face", "faces", "added where a border vertex lies on another edge");
    note(out.flat_faces, "face", "faces", "kept without area on the grid");
    note_pieces(out.turned_pieces, "turned from inwards to outwards; --keep-winding prevents this");
    note_pieces(out.turned_voids,
                "turned inwards, as a void in a closed piece; --keep-winding prevents this");
}

/// Joins the sides of seams that the source has rounded differently.
void close_seams(TriangleMesh& mesh, const PrepareOptions& options, PreparedMesh& out)
{
    const double step = out.quantum_m / out.metres_per_unit;
    const detail::JoinedBorders joined = detail::join_borders(mesh, step / kStepsApart);
    if (joined.vertices > 0)
    {
        out.joined_vertices = joined.vertices;
        out.quantisation_m = joined.farthest * out.metres_per_unit;
        mesh = clean_up(std::move(mesh), out);
        out.welded_vertices -= joined.vertices;
    }
    if (joined.are_there)
    {
        const std::size_t own = mesh.positions.size();
        for (const auto& [x, y, z] : options.beside_m)
        {
            const double scale = out.metres_per_unit;
            mesh.positions.push_back({x / scale, y / scale, z / scale});
        }
        out.stitched_faces = detail::stitch_edges(mesh, step / kStepsOnEdge, own);
        if (!options.beside_m.empty())
        {
            detail::drop_isolated_vertices(mesh);
        }
    }
}

/// A cleaned mesh and its box, both in the source's unit.
struct PlannedMesh
{
    TriangleMesh mesh;
    Box box;
};

Result<PlannedMesh, Refusal> plan_mesh(const TriangleMesh& source, const PrepareOptions& options,
                                       PreparedMesh& out)
{
    if (auto error = find_bad_option(options))
    {
        return *error;
    }
    if (auto error = find_bad_source(source))
    {
        return *error;
    }
    PlannedMesh planned{clean_up(source, out), {}};
    if (planned.mesh.faces.empty())
    {
        return Refusal{fmt::format("no face is left of {}: {} are degenerate; at least 1 is "
                                   "needed",
                                   source.faces.size(), out.degenerate_faces)};
    }
    planned.box = box_of(planned.mesh.positions);
    if (auto error = choose_scale(planned.box, options, out))
    {
        return *error;
    }
    choose_grid(planned.mesh, planned.box.largest_extent() * out.metres_per_unit, options, out);
    return planned;
}

} // namespace

std::optional<double> metres_per_unit(std::string_view unit)
{
    constexpr std::array<std::pair<std::string_view, double>, 5> kUnits{
        {{"mm", 0.001}, {"cm", 0.01}, {"m", 1.0}, {"in", 0.0254}, {"inch", 0.0254}}};
    const auto is_same_letter = [](char a, char b)
    { return a == b || (a >= 'A' && a <= 'Z' && a - 'A' + 'a' == b); };
    for (const auto& [name, metres] : kUnits)
    {
        if (std::ranges::equal(unit, name, is_same_letter))
        {
            return metres;
        }
    }
    return std::nullopt;
}

Result<double, Refusal> grid_step(const TriangleMesh& source, const PrepareOptions& options)
{
    PreparedMesh out;
    const auto planned = plan_mesh(source, options, out);
    return planned ? Result<double, Refusal>(out.quantum_m) : planned.error();
}

Result<PreparedMesh, Refusal> prepare_mesh(const TriangleMesh& source,
                                           const PrepareOptions& options)
{
    PreparedMesh out;
    auto planned = plan_mesh(source, options, out);
    if (!planned)
    {
        return planned.error();
    }
    auto& [mesh, box] = planned.value();
    if (options.stitches)
    {
        close_seams(mesh, options, out);
    }
    make_manifold(mesh, out);
    if (!options.keeps_winding)
    {
        const detail::TurnedPieces turned = detail::turn_closed_pieces(mesh);
        out.turned_pieces = turned.outward;
        out.turned_voids = turned.inward;
    }
    put_on_grid(mesh, box, options, out);
    out.mesh.faces = std::move(mesh.faces);
    out.flat_faces = static_cast<std::size_t>(
        std::count_if(out.mesh.faces.begin(), out.mesh.faces.end(),
                      [&out](const auto& face) { return is_flat(out.mesh, face); }));
    write_notes(out);
    return out;
}

} // namespace tactus
