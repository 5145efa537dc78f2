// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/prepare_steps.hpp"
#include "host_tools/mesh/index_lists.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

/// A piece is a set of faces connected by vertices. It is closed when each of its vertices has a
/// closed fan. The corners of a fan round v are (v, n0, n1), (v, n1, n2) .. (v, nk-1, nk), so the
/// sum of the second corners less that of the third is n0 - nk, which is 0 exactly if the fan
/// closes.
///
/// A point lies in a closed piece if the ray from it along +x crosses an odd number of faces. A
/// face is crossed if the ray along +y, in the plane of y and z, crosses an odd number of its
/// projected edges. Both faces of an edge compute that crossing from the same numbers in the same
/// order, so rounding opens no gap between them.
namespace tactus::detail
{

namespace
{

using Point = std::array<double, 3>;
using Face = std::array<std::uint32_t, 3>;

/// Maximum number of vertices of a piece that are tested for being inside another piece.
constexpr std::uint32_t kMaxSamples = 16;
/// Share of the summed magnitudes below which volumes and distances are rounding errors.
constexpr double kNoise = 1e-12;
constexpr std::size_t kMaxCellsAlong = 1024;

struct Piece
{
    bool is_closed{true};
    double six_volume{0.0}; ///< Six times the volume, in cubes of the extent.
    /// The sum of the absolute values of the terms of `six_volume`.
    double six_absolute_volumes{0.0};
    std::uint32_t vertices{0};
    Point low{};
    Point high{};

    [[nodiscard]] double extent() const
    {
        return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    }
    [[nodiscard]] bool has_volume() const
    {
        return std::abs(six_volume) > kNoise * six_absolute_volumes;
    }
    /// True if the box of `other` lies strictly within the box of this piece.
    [[nodiscard]] bool is_round(const Piece& other) const
    {
        bool is_in = true;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            is_in = is_in && low[axis] < other.low[axis] && other.high[axis] < high[axis];
        }
        return is_in;
    }
};

/// Numbers the pieces in the order of their first vertices.
class PieceFinder
{
public:
    explicit PieceFinder(const TriangleMesh& mesh) : mesh_(mesh), root_(mesh.positions.size())
    {
        std::iota(root_.begin(), root_.end(), 0U);
        for (const Face& face : mesh.faces)
        {
            join(face[0], face[1]);
            join(face[1], face[2]);
        }
    }

    /// Finds the pieces; `piece_of` receives that of each vertex.
    std::vector<Piece> find(std::vector<std::uint32_t>& piece_of)
    {
        std::vector<Piece> pieces;
        piece_of.resize(root_.size());
        for (std::uint32_t v = 0; v < root_.size(); ++v)
        {
            // The least vertex of the piece, visited before its others.
            const std::uint32_t root = root_of(v);
            if (root == v)
            {
                piece_of[v] = static_cast<std::uint32_t>(pieces.size());
                pieces.push_back({.low = mesh_.positions[v], .high = mesh_.positions[v]});
            }
            piece_of[v] = piece_of[root];
            take_vertex(pieces[piece_of[v]], mesh_.positions[v]);
        }
        for (const Face& face : mesh_.faces)
        {
            add_volume(pieces[piece_of[face[0]]], face, mesh_.positions[root_of(face[0])]);
        }
        mark_open(pieces, piece_of);
        return pieces;
    }

private:
    std::uint32_t root_of(std::uint32_t v)
    {
        while (root_[v] != v)
        {
            root_[v] = root_[root_[v]];
            v = root_[v];
        }
        return v;
    }

    void join(std::uint32_t a, std::uint32_t b)
    {
        const auto [least, other] = std::minmax({root_of(a), root_of(b)});
        root_[other] = least;
    }

    static void take_vertex(Piece& piece, const Point& p)
    {
        ++piece.vertices;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            piece.low[axis] = std::min(piece.low[axis], p[axis]);
            piece.high[axis] = std::max(piece.high[axis], p[axis]);
        }
    }

    /// Adds the volume of the tetrahedron of a face and `apex`, a vertex of its piece: far from the
    /// origin, that loses no digits.
    void add_volume(Piece& piece, const Face& face, const Point& apex)
    {
        // Lengths are scaled, since squares of tiny or huge ones are out of range.
        const double extent = piece.extent();
        std::array<Point, 3> side{};
        for (std::size_t k = 0; k < 3; ++k)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                side[k][axis] = (mesh_.positions[face[k]][axis] - apex[axis]) / extent;
            }
        }
        const auto& [a, b, c] = side;
        const double six_volume = a[0] * (b[1] * c[2] - b[2] * c[1]) +
                                  a[1] * (b[2] * c[0] - b[0] * c[2]) +
                                  a[2] * (b[0] * c[1] - b[1] * c[0]);
        piece.six_volume += six_volume;
        piece.six_absolute_volumes += std::abs(six_volume);
    }

    void mark_open(std::vector<Piece>& pieces, const std::vector<std::uint32_t>& piece_of) const
    {
        // Sum by vertex as described above, modulo 2^32.
        std::vector<std::uint32_t> first_less_last(piece_of.size(), 0);
        for (const Face& face : mesh_.faces)
        {
            for (std::size_t k = 0; k < 3; ++k)
            {
                first_less_last[face[k]] += face[(k + 1) % 3] - face[(k + 2) % 3];
            }
        }
        for (std::size_t v = 0; v < piece_of.size(); ++v)
        {
            Piece& piece = pieces[piece_of[v]];
            piece.is_closed = piece.is_closed && first_less_last[v] == 0;
        }
    }

    const TriangleMesh& mesh_;
    /// Union-find: a lower vertex of the same piece, by vertex; the least one is its own entry.
    std::vector<std::uint32_t> root_;
};

struct Sample
{
    Point place{};
    std::uint32_t piece{0};
};

/// Sample points in the cells of a grid over y and z.
class SampleGrid
{
public:
    explicit SampleGrid(std::vector<Sample> samples) : samples_(std::move(samples))
    {
        along_ = std::clamp<std::size_t>(
            static_cast<std::size_t>(std::sqrt(static_cast<double>(samples_.size()))), 1,
            kMaxCellsAlong);
        for (const Sample& sample : samples_)
        {
            for (std::size_t k = 0; k < 2; ++k)
            {
                low_[k] = std::min(low_[k], sample.place[k + 1]);
                high_[k] = std::max(high_[k], sample.place[k + 1]);
            }
        }
        std::stable_sort(samples_.begin(), samples_.end(),
                         [this](const Sample& a, const Sample& b)
                         { return cell_of(a) < cell_of(b); });
        start_.assign(along_ * along_ + 1, 0);
        for (const Sample& sample : samples_)
        {
            ++start_[cell_of(sample) + 1];
        }
        std::partial_sum(start_.begin(), start_.end(), start_.begin());
    }

    [[nodiscard]] const std::vector<Sample>& samples() const { return samples_; }

    /// Calls visit(index) for each sample in the cells of the face's box.
    template <typename Visit>
    void visit_behind(const std::array<Point, 3>& face, Visit visit) const
    {
        std::array<std::size_t, 2> first{};
        std::array<std::size_t, 2> last{};
        for (std::size_t k = 0; k < 2; ++k)
        {
            const auto [low, high] = std::minmax({face[0][k + 1], face[1][k + 1], face[2][k + 1]});
            if (high < low_[k] || low > high_[k])
            {
                return;
            }
            first[k] = step_of(low, k);
            last[k] = step_of(high, k);
        }
        for (std::size_t row = first[1]; row <= last[1]; ++row)
        {
            const std::size_t end = start_[row * along_ + last[0] + 1];
            for (std::size_t i = start_[row * along_ + first[0]]; i < end; ++i)
            {
                visit(i);
            }
        }
    }

private:
    [[nodiscard]] std::size_t step_of(double c, std::size_t k) const
    {
        const double extent = high_[k] - low_[k];
        const double part = extent > 0.0 ? std::clamp((c - low_[k]) / extent, 0.0, 1.0) : 0.0;
        return std::min(static_cast<std::size_t>(part * static_cast<double>(along_)), along_ - 1);
    }
    [[nodiscard]] std::size_t cell_of(const Sample& sample) const
    {
        return step_of(sample.place[2], 1) * along_ + step_of(sample.place[1], 0);
    }

    std::vector<Sample> samples_; ///< Samples in the order of their cells.
    std::size_t along_{1};
    std::array<double, 2> low_{std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity()};
    std::array<double, 2> high_{-std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity()};
    /// Index of each cell's first sample; the last entry is their number.
    std::vector<std::size_t> start_;
};

/// True if the ray along +y from the point crosses the edge, in the plane of y and z.
bool crosses_edge(const Point& a, const Point& b, const Point& p)
{
    if ((a[2] > p[2]) == (b[2] > p[2]))
    {
        return false;
    }
    return a[1] + (p[2] - a[2]) / (b[2] - a[2]) * (b[1] - a[1]) > p[1];
}

enum class Crossing
{
    none,
    ahead,
    touching,
};

/// Crossing of the face with the line through the point along x. Each edge is tested from its lower
/// vertex to its higher, so both its faces get the same result.
Crossing crossing_of(const Face& face, const std::array<Point, 3>& corners, const Point& p)
{
    bool is_crossed = false;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const std::size_t next = (k + 1) % 3;
        const bool is_up = face[k] < face[next];
        is_crossed ^= crosses_edge(corners[is_up ? k : next], corners[is_up ? next : k], p);
    }
    if (!is_crossed)
    {
        return Crossing::none;
    }
    const auto& [a, b, c] = corners;
    const double ab_y = b[1] - a[1];
    const double ab_z = b[2] - a[2];
    const double ac_y = c[1] - a[1];
    const double ac_z = c[2] - a[2];
    const double ap_y = p[1] - a[1];
    const double ap_z = p[2] - a[2];
    const double area = ab_y * ac_z - ab_z * ac_y;
    const double s = area == 0.0 ? 0.0 : (ap_y * ac_z - ap_z * ac_y) / area;
    const double t = area == 0.0 ? 0.0 : (ab_y * ap_z - ab_z * ap_y) / area;
    const double x = a[0] + s * (b[0] - a[0]) + t * (c[0] - a[0]);
    const double extent = std::abs(b[0] - a[0]) + std::abs(c[0] - a[0]) + std::abs(p[0] - a[0]);
    if (std::abs(x - p[0]) <= kNoise * extent)
    {
        return Crossing::touching;
    }
    return x > p[0] ? Crossing::ahead : Crossing::none;
}

/// Number of closed pieces around each piece.
class Nesting
{
public:
    Nesting(const TriangleMesh& mesh, const std::vector<Piece>& pieces,
            const std::vector<std::uint32_t>& piece_of)
        : mesh_(mesh)
        , pieces_(pieces)
        , grid_(take_samples(mesh, pieces, piece_of))
        , faces_(pieces.size(),
                 [&](const auto& add)
                 {
                     for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
                     {
                         add(piece_of[mesh.faces[f][0]], f);
                     }
                 })
    {
        samples_of_.assign(pieces.size(), 0);
        for (const Sample& sample : grid_.samples())
        {
            ++samples_of_[sample.piece];
        }
        hits_.assign(grid_.samples().size(), 0);
    }

    std::vector<std::uint32_t> depths()
    {
        std::vector<std::uint32_t> depth(pieces_.size(), 0);
        // Samples of each piece that are inside piece b.
        std::vector<std::uint32_t> inside(pieces_.size(), 0);
        for (std::uint32_t b = 0; b < pieces_.size(); ++b)
        {
            if (pieces_[b].is_closed)
            {
                for (const std::uint32_t face : faces_.of(b))
                {
                    count_behind(face, b);
                }
            }
            for (const std::size_t i : hit_)
            {
                const std::uint32_t a = grid_.samples()[i].piece;
                if (hits_[i] < kTouched && hits_[i] % 2 == 1 && ++inside[a] == samples_of_[a])
                {
                    ++depth[a];
                }
            }
            for (const std::size_t i : hit_)
            {
                inside[grid_.samples()[i].piece] = 0;
                hits_[i] = 0;
            }
            hit_.clear();
        }
        return depth;
    }

private:
    /// Flag in `hits_`: the sample lies on a face of piece b.
    static constexpr std::uint32_t kTouched = 0x8000'0000U;

    static std::vector<Sample> take_samples(const TriangleMesh& mesh,
                                            const std::vector<Piece>& pieces,
                                            const std::vector<std::uint32_t>& piece_of)
    {
        std::vector<Sample> samples;
        std::vector<std::uint32_t> seen(pieces.size(), 0);
        for (std::uint32_t v = 0; v < piece_of.size(); ++v)
        {
            const Piece& piece = pieces[piece_of[v]];
            const std::uint32_t step = (piece.vertices + kMaxSamples - 1) / kMaxSamples;
            if (piece.is_closed && seen[piece_of[v]]++ % step == 0)
            {
                samples.push_back({mesh.positions[v], piece_of[v]});
            }
        }
        return samples;
    }

    void count_behind(std::uint32_t f, std::uint32_t b)
    {
        const Face& face = mesh_.faces[f];
        const std::array<Point, 3> corners{mesh_.positions[face[0]], mesh_.positions[face[1]],
                                           mesh_.positions[face[2]]};
        grid_.visit_behind(corners,
                           [&](std::size_t i)
                           {
                               const Sample& sample = grid_.samples()[i];
                               if (sample.piece == b || !pieces_[b].is_round(pieces_[sample.piece]))
                               {
                                   return;
                               }
                               const Crossing crossing = crossing_of(face, corners, sample.place);
                               if (crossing == Crossing::none)
                               {
                                   return;
                               }
                               if (hits_[i] == 0)
                               {
                                   hit_.push_back(i);
                               }
                               hits_[i] = crossing == Crossing::touching ? hits_[i] | kTouched
                                                                         : hits_[i] + 1;
                           });
    }

    const TriangleMesh& mesh_;
    const std::vector<Piece>& pieces_;
    SampleGrid grid_;
    IndexLists faces_;                      ///< Faces by piece.
    std::vector<std::uint32_t> samples_of_; ///< Number of samples by piece.
    /// Number of faces of piece b ahead of each sample along +x, and the flag kTouched.
    std::vector<std::uint32_t> hits_;
    std::vector<std::size_t> hit_; ///< Indices of samples whose hits are not 0.
};

/// True if an open piece may enclose this one. A piece of three vertices encloses nothing.
bool is_doubtful(const Piece& piece, const std::vector<Piece>& pieces)
{
    return std::ranges::any_of(
        pieces, [&](const Piece& other)
        { return !other.is_closed && other.vertices > 3 && other.is_round(piece); });
}

} // namespace

TurnedPieces turn_closed_pieces(TriangleMesh& mesh)
{
    std::vector<std::uint32_t> piece_of;
    const std::vector<Piece> pieces = PieceFinder(mesh).find(piece_of);
    const auto closed = std::ranges::count_if(pieces, &Piece::is_closed);
    std::vector<std::uint32_t> depth(pieces.size(), 0);
    if (closed > 1)
    {
        depth = Nesting(mesh, pieces, piece_of).depths();
    }
    TurnedPieces turned;
    std::vector<bool> is_wrong(pieces.size(), false);
    for (std::size_t i = 0; i < pieces.size(); ++i)
    {
        const Piece& piece = pieces[i];
        const bool is_void = depth[i] % 2 == 1;
        if (piece.is_closed && piece.has_volume() && (piece.six_volume < 0.0) != is_void &&
            !is_doubtful(piece, pieces))
        {
            is_wrong[i] = true;
            ++(is_void ? turned.inward : turned.outward);
        }
    }
    for (Face& face : mesh.faces)
    {
        if (is_wrong[piece_of[face[0]]])
        {
            std::swap(face[1], face[2]);
        }
    }
    return turned;
}

} // namespace tactus::detail
