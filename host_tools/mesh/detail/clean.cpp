// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/prepare_steps.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace tactus::detail
{

namespace
{

constexpr std::uint32_t kNoItem = 0xFFFF'FFFFU;

/// Finalizer like that of splitmix64: every input bit affects every output bit.
std::uint64_t mix(std::uint64_t x)
{
    x ^= x >> 32U;
    x *= 0xD6E8'FEB8'6659'FD93U;
    x ^= x >> 32U;
    x *= 0xD6E8'FEB8'6659'FD93U;
    return x ^ (x >> 32U);
}

std::uint64_t hash_of(const std::array<double, 3>& p)
{
    std::uint64_t hash = 0;
    for (const double c : p)
    {
        hash = mix(hash ^ std::bit_cast<std::uint64_t>(c + 0.0)); // -0 becomes 0.
    }
    return hash;
}

std::uint64_t hash_of(const Face& face)
{
    return mix(mix((static_cast<std::uint64_t>(face[0]) << 32U) | face[1]) ^ face[2]);
}

/// Hash table over indices into an external array, with open addressing, at most half full. Queries
/// only return the first equal item, so the result does not depend on the table's order.
class FirstEqualTable
{
public:
    explicit FirstEqualTable(std::size_t items) : slots_(std::bit_ceil(2 * items + 2), kNoItem) {}

    /// First item equal to `item`; a new item is inserted and returned.
    template <typename IsEqual>
    std::uint32_t find_or_insert(std::uint32_t item, std::uint64_t hash, IsEqual is_equal)
    {
        std::size_t at = hash & (slots_.size() - 1);
        while (slots_[at] != kNoItem && !is_equal(slots_[at]))
        {
            at = (at + 1) & (slots_.size() - 1);
        }
        slots_[at] = slots_[at] == kNoItem ? item : slots_[at];
        return slots_[at];
    }

private:
    std::vector<std::uint32_t> slots_;
};

/// Rotates the corners so that the least vertex is the first; the orientation stays.
Face turned_to_least(const Face& f)
{
    if (f[0] < f[1] && f[0] < f[2])
    {
        return f;
    }
    return f[1] < f[2] ? Face{f[1], f[2], f[0]} : Face{f[2], f[0], f[1]};
}

Face sorted(Face face)
{
    std::sort(face.begin(), face.end());
    return face;
}

/// Index of the first face with the same key, by face.
template <typename Key>
std::vector<std::uint32_t> first_with_equal_key(const std::vector<Face>& faces, Key key)
{
    FirstEqualTable table(faces.size());
    std::vector<std::uint32_t> first(faces.size());
    for (std::uint32_t f = 0; f < faces.size(); ++f)
    {
        const Face mine = key(faces[f]);
        first[f] = table.find_or_insert(
            f, hash_of(mine), [&](std::uint32_t other) { return key(faces[other]) == mine; });
    }
    return first;
}

} // namespace

std::size_t weld_equal_positions(TriangleMesh& mesh)
{
    FirstEqualTable table(mesh.positions.size());
    std::vector<std::uint32_t> first(mesh.positions.size());
    std::size_t welded = 0;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
    {
        const auto& mine = mesh.positions[v];
        first[v] = table.find_or_insert(
            v, hash_of(mine), [&](std::uint32_t other) { return mesh.positions[other] == mine; });
        welded += first[v] != v ? 1U : 0U;
    }
    for (Face& face : mesh.faces)
    {
        face = {first[face[0]], first[face[1]], first[face[2]]};
    }
    return welded;
}

std::size_t drop_degenerate_faces(std::vector<Face>& faces)
{
    return std::erase_if(faces, [](const Face& f)
                         { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; });
}

std::size_t drop_duplicate_faces(std::vector<Face>& faces)
{
    const auto first = first_with_equal_key(faces, turned_to_least);
    std::size_t kept = 0;
    for (std::uint32_t f = 0; f < faces.size(); ++f)
    {
        if (first[f] == f)
        {
            faces[kept++] = faces[f];
        }
    }
    const std::size_t dropped = faces.size() - kept;
    faces.resize(kept);
    return dropped;
}

std::size_t drop_isolated_vertices(TriangleMesh& mesh)
{
    std::vector<std::uint32_t> number(mesh.positions.size(), kNoItem);
    for (const Face& face : mesh.faces)
    {
        number[face[0]] = number[face[1]] = number[face[2]] = 0;
    }
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < number.size(); ++v)
    {
        if (number[v] != kNoItem)
        {
            mesh.positions[kept] = mesh.positions[v];
            number[v] = kept++;
        }
    }
    const std::size_t dropped = mesh.positions.size() - kept;
    mesh.positions.resize(kept);
    for (Face& face : mesh.faces)
    {
        face = {number[face[0]], number[face[1]], number[face[2]]};
    }
    return dropped;
}

std::vector<std::uint8_t> mark_opposite_copies(const std::vector<Face>& faces)
{
    const auto first = first_with_equal_key(faces, sorted);
    std::vector<std::uint8_t> is_copy(faces.size(), 0);
    bool any = false;
    for (std::uint32_t f = 0; f < faces.size(); ++f)
    {
        is_copy[f] = first[f] != f ? 1 : 0;
        any = any || first[f] != f;
    }
    return any ? is_copy : std::vector<std::uint8_t>{};
}

} // namespace tactus::detail
