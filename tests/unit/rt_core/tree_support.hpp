// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/records/local_surface.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/shared/validate_tree.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

namespace tactus::test
{

inline constexpr float kTreeQuantum = 0x1p-10F;

/// AB-Tree with its expected faces by prim.
class TreeRig
{
public:
    explicit TreeRig(const TreeCapacities& capacities)
        : memory_(required(capacities)), faces_(capacities.prims)
    {
        Arena arena(memory_.bytes());
        pool_.emplace(arena, capacities);
        sut.emplace(*pool_, ModelId{0}, capacities, kTreeQuantum);
    }

    /// Sets the present state of one face: new, changed corner by corner, or removed (face none).
    void put(const ChangedFace& face)
    {
        ChangedFace& held = faces_[face.prim.value];
        if (!face.face.is_none() && held.face == face.face && held.bucket == face.bucket)
        {
            for (std::uint32_t corner = 0; corner < 3; ++corner)
            {
                sut->move_corner(face.prim, corner, face.corners_m[corner], face.error);
            }
        }
        else
        {
            if (!held.face.is_none())
            {
                sut->remove(face.prim);
            }
            if (!face.face.is_none())
            {
                sut->insert(face);
            }
        }
        held = face;
    }
    void remove(std::uint32_t prim) { put(ChangedFace{PrimId{prim}, FaceId{}, 0, 0, {}}); }
    /// Offers the unplaced faces again, as a frame does.
    void offer_again()
    {
        sut->offer_unplaced([this](PrimId prim) { return faces_[prim.value]; });
    }
    [[nodiscard]] const ChangedFace& face(std::uint32_t prim) const { return faces_[prim]; }
    [[nodiscard]] std::vector<ChangedFace> present() const
    {
        std::vector<ChangedFace> faces;
        for (const ChangedFace& face : faces_)
        {
            if (!face.face.is_none())
            {
                faces.push_back(face);
            }
        }
        return faces;
    }
    [[nodiscard]] std::string faults() const { return tree_faults(*sut, present()); }

    static std::size_t required(const TreeCapacities& capacities)
    {
        Arena arena = Arena::measuring();
        const TreePool pool(arena, capacities);
        return arena.used();
    }

private:
    ArenaMemory memory_;
    std::optional<TreePool> pool_;
    std::vector<ChangedFace> faces_;

public:
    std::optional<AbTree> sut;
};

/// Greatest error of three random faces.
inline ErrorCode large_error(Random& random, std::span<const ChangedFace> faces)
{
    ErrorCode largest = 0;
    for (int i = 0; i < 3; ++i)
    {
        largest = std::max(largest, faces[random.below(faces.size())].error);
    }
    return largest;
}

/// Distribution of a test's faces in path space and in space.
struct FaceStyle
{
    const char* name;
    std::uint32_t (*bucket)(std::uint32_t face);
    bool shares_vertices; ///< Corners on a small grid, so that blocks fill with faces.
};

inline const std::array<FaceStyle, 5>& face_styles()
{
    static const std::array<FaceStyle, 5> styles{
        {{"spread", [](std::uint32_t face) { return face * 2'654'435'761U; }, true},
         {"clustered", [](std::uint32_t face) { return face / 8; }, true},
         {"all_equal", [](std::uint32_t) { return 7U; }, true},
         {"unshared", [](std::uint32_t face) { return face / 8; }, false},
         {"two_far_clusters",
          [](std::uint32_t face) { return (face % 2 == 0 ? 0xFFFF'FF00U : 0U) + face / 16; },
          false}}};
    return styles;
}

/// Small random triangle near the face's place along a line, in a cube of about 4 m.
[[nodiscard]] inline ChangedFace random_face(Random& random, const FaceStyle& style,
                                             std::uint32_t prim, std::uint32_t face)
{
    ChangedFace changed{PrimId{prim}, FaceId{face}, style.bucket(face), 0, {}};
    const double along = 0.01 * static_cast<double>(face % 400) - 2.0;
    for (Vec3f& corner : changed.corners_m)
    {
        corner = style.shares_vertices
                     ? Vec3f{static_cast<float>(0.0625 * std::floor(along * 16.0) +
                                                0.0625 * random.below(2)),
                             0.5F * static_cast<float>(random.below(2)),
                             0.5F * static_cast<float>(random.below(2))}
                     : to_float(Vec3(along, 0.0, 0.0) + random.in_cube(0.05));
    }
    if (random.one_in(3))
    {
        changed.error = static_cast<ErrorCode>(1 + random.below(60));
    }
    return changed;
}

/// Adds `count` faces of a style, each with its prim as its id, and refits.
inline void fill_style(TreeRig& rig, Random& random, const FaceStyle& style, std::uint32_t count)
{
    for (std::uint32_t prim = 0; prim < count; ++prim)
    {
        rig.put(random_face(random, style, prim, prim));
    }
    rig.sut->refit();
}
/// Faces of a surface, each once.
[[nodiscard]] inline std::set<std::uint32_t> faces_of(const AbTree& tree,
                                                      const LocalSurface& surface)
{
    std::set<std::uint32_t> faces;
    for (std::uint32_t i = 0; i < surface.count; ++i)
    {
        const std::uint32_t face = tree.face_of(surface.triangles[i].prim).value;
        EXPECT_TRUE(faces.insert(face).second) << face;
    }
    return faces;
}

} // namespace tactus::test
