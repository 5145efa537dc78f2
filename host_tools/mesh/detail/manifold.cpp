// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "host_tools/mesh/detail/prepare_steps.hpp"

#include <algorithm>
#include <span>

/// A half-edge h = 3 f + k runs from corner k of face f to the next corner. Two half-edges that
/// share their end points in opposite directions may be paired; unpaired ones are border. Walking
/// over pairs around a vertex visits the corners of one fan, and each fan gets a vertex of its own:
///
///         \ f2 | f1 /             \ f2 | f1 /
///          \   |   /               \   |   /
///     ------- v -------   =>      ---- v  ----      v' lies where v lies.
///          /   |                       v'
///         / f3 | f4                / f3 | f4
///
/// One pass is enough without opposite copies: at an edge all half-edges are unpaired or exactly
/// two are paired. No two unpaired half-edges of the same direction share a fan at either end,
/// since each would have to be that fan's first (or last) face. Afterwards an edge therefore has at
/// most one face in each direction. Two opposite unpaired half-edges that keep both end points in
/// common are the two ends of one fan at each, which closes the fan.
///
/// Opposite copies (two-sided sheets) give every edge more than two faces. They are paired in a
/// first pass with copies only among copies; there pairs and borders mix at one edge, the argument
/// above does not hold, and the plain pass afterwards makes it hold.
namespace tactus::detail
{

namespace
{

constexpr std::uint32_t kNoTwin = 0xFFFF'FFFFU;

std::uint32_t next(std::uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}
std::uint32_t previous(std::uint32_t h)
{
    return h % 3 == 0 ? h + 2 : h - 1;
}

class Splitter
{
public:
    /// `is_copy` flags opposite copies, by face; empty in the plain pass.
    Splitter(std::vector<Face>& faces, std::uint32_t vertex_count,
             std::vector<std::uint8_t> is_copy)
        : faces_(faces)
        , vertex_count_(vertex_count)
        , is_copy_(std::move(is_copy))
        , twin_(3 * faces.size(), kNoTwin)
    {
    }

    ManifoldSplit run()
    {
        pair_half_edges();
        give_each_fan_a_vertex();
        return std::move(result_);
    }

private:
    [[nodiscard]] std::uint32_t from(std::uint32_t h) const { return faces_[h / 3][h % 3]; }
    [[nodiscard]] std::uint32_t to(std::uint32_t h) const { return from(next(h)); }
    [[nodiscard]] std::uint32_t least(std::uint32_t h) const { return std::min(from(h), to(h)); }
    [[nodiscard]] std::uint32_t largest(std::uint32_t h) const { return std::max(from(h), to(h)); }
    [[nodiscard]] bool is_copy(std::uint32_t h) const
    {
        return !is_copy_.empty() && is_copy_[h / 3] != 0;
    }

    /// Sorts half-edges into buckets by their least end point, sorts each bucket by the other end
    /// point, and pairs the half-edges of each edge.
    void pair_half_edges()
    {
        const auto half_edges = static_cast<std::uint32_t>(twin_.size());
        std::vector<std::uint32_t> start(std::size_t{vertex_count_} + 1, 0);
        for (std::uint32_t h = 0; h < half_edges; ++h)
        {
            ++start[least(h) + 1];
        }
        for (std::size_t v = 0; v < vertex_count_; ++v)
        {
            start[v + 1] += start[v];
        }
        std::vector<std::uint32_t> bucket(half_edges);
        for (std::uint32_t h = half_edges; h-- > 0;)
        {
            bucket[--start[least(h) + 1]] = h;
        }
        // After filling from the back, start[v + 1] is the start of v's bucket.
        for (std::size_t v = 0; v < vertex_count_; ++v)
        {
            const std::size_t end = v + 1 < vertex_count_ ? start[v + 2] : half_edges;
            pair_in_bucket(std::span(bucket).subspan(start[v + 1], end - start[v + 1]));
        }
    }

    void pair_in_bucket(std::span<std::uint32_t> bucket)
    {
        std::sort(bucket.begin(), bucket.end(),
                  [this](std::uint32_t a, std::uint32_t b)
                  {
                      const std::uint32_t x = largest(a);
                      const std::uint32_t y = largest(b);
                      return x != y ? x < y : a < b;
                  });
        while (!bucket.empty())
        {
            std::size_t count = 1;
            while (count < bucket.size() && largest(bucket[count]) == largest(bucket[0]))
            {
                ++count;
            }
            pair_at_edge(bucket.first(count));
            bucket = bucket.subspan(count);
        }
    }

    void pair_at_edge(std::span<std::uint32_t> edge)
    {
        if (edge.size() < 2 || try_pair(edge))
        {
            return;
        }
        if (!is_copy_.empty())
        {
            const auto middle = std::stable_partition(
                edge.begin(), edge.end(), [this](std::uint32_t h) { return !is_copy(h); });
            const auto originals = static_cast<std::size_t>(middle - edge.begin());
            const auto copies = edge.subspan(originals);
            const bool sheet = originals <= 1 && copies.size() <= 1;
            const bool first_side = try_pair(edge.first(originals));
            const bool second_side = try_pair(copies);
            if (sheet || (first_side && second_side))
            {
                return; // The edge is separated along the whole sheet, which is not a cut.
            }
        }
        ++result_.cut_edges;
    }

    /// Pairs two half-edges of opposite direction if there are exactly two, but never a face with
    /// its own opposite.
    bool try_pair(std::span<const std::uint32_t> edge)
    {
        if (edge.size() != 2 || from(edge[0]) == from(edge[1]) ||
            to(next(edge[0])) == to(next(edge[1])))
        {
            return false;
        }
        twin_[edge[0]] = edge[1];
        twin_[edge[1]] = edge[0];
        return true;
    }

    /// Keeps the vertex for the fan of its first corner; later fans get copies.
    void give_each_fan_a_vertex()
    {
        std::vector<std::uint32_t> vertex_of(twin_.size(), kNoTwin); // Vertex of each corner.
        std::vector<bool> taken(vertex_count_, false);
        for (std::uint32_t corner = 0; corner < vertex_of.size(); ++corner)
        {
            if (vertex_of[corner] != kNoTwin)
            {
                continue;
            }
            std::uint32_t vertex = from(corner);
            if (taken[vertex])
            {
                result_.copy_of.push_back(vertex);
                vertex = vertex_count_ + static_cast<std::uint32_t>(result_.copy_of.size()) - 1;
            }
            else
            {
                taken[vertex] = true;
            }
            name_fan(corner, vertex, vertex_of);
        }
        for (std::uint32_t corner = 0; corner < vertex_of.size(); ++corner)
        {
            faces_[corner / 3][corner % 3] = vertex_of[corner];
        }
    }

    void name_fan(std::uint32_t start, std::uint32_t vertex, std::vector<std::uint32_t>& vertex_of)
    {
        std::uint32_t corner = start;
        do // Counter-clockwise, over the incoming edge.
        {
            vertex_of[corner] = vertex;
            corner = twin_[previous(corner)];
        } while (corner != kNoTwin && corner != start);
        if (corner == start)
        {
            return;
        }
        for (std::uint32_t h = twin_[start]; h != kNoTwin; h = twin_[corner]) // Clockwise.
        {
            corner = next(h);
            vertex_of[corner] = vertex;
        }
    }

    std::vector<Face>& faces_;
    std::uint32_t vertex_count_;
    std::vector<std::uint8_t> is_copy_;
    std::vector<std::uint32_t> twin_;
    ManifoldSplit result_;
};

} // namespace

ManifoldSplit split_into_manifold(std::vector<Face>& faces, std::uint32_t vertex_count)
{
    ManifoldSplit total;
    auto is_copy = mark_opposite_copies(faces);
    if (!is_copy.empty())
    {
        total = Splitter(faces, vertex_count, std::move(is_copy)).run();
    }
    const auto so_far = static_cast<std::uint32_t>(total.copy_of.size());
    const ManifoldSplit plain = Splitter(faces, vertex_count + so_far, {}).run();
    total.cut_edges += plain.cut_edges;
    for (const std::uint32_t vertex : plain.copy_of)
    {
        total.copy_of.push_back(vertex < vertex_count ? vertex
                                                      : total.copy_of[vertex - vertex_count]);
    }
    return total;
}

} // namespace tactus::detail
