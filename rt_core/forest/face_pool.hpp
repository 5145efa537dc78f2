// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/base/model_id.hpp"
#include "rt_core/base/pool_room.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/changed_face.hpp"
#include "rt_core/spm/page.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <span>

namespace tactus
{

/// One active face: 20 B, plus 16 B in the index list.
struct ActiveFace
{
    FaceId id{};
    std::array<VertexId, 3> corners{};
    FaceState state;
};

/// The active faces of several models, each found by its owner and id. 36 B per face.
///
/// Haptic thread only.
class FacePool
{
public:
    FacePool(Arena& arena, std::uint32_t capacity) noexcept
        : faces_(arena.take<ActiveFace>(capacity)), index_list_(arena, capacity), room_(capacity)
    {
        TACTUS_ASSERT(capacity <= kMaxPoolFaces);
        for (std::uint32_t i = 0; i < capacity && !arena.is_measuring(); ++i)
        {
            faces_[i].corners[0] = VertexId{i + 1};
        }
    }

    /// Reserves `faces` for a new owner, or as many as are neither taken nor reserved.
    [[nodiscard]] PoolShare promise(std::uint32_t faces) noexcept { return room_.promise(faces); }
    /// Reserves `faces` for an owner without a reservation. False, with nothing changed, if fewer
    /// are neither taken nor reserved.
    [[nodiscard]] bool try_promise(PoolShare& share, std::uint32_t faces) noexcept
    {
        return room_.try_promise(share, faces);
    }
    void end_promise(PoolShare& share) noexcept { room_.end_promise(share); }
    /// Number of faces that an owner may still add.
    [[nodiscard]] std::uint32_t left_for(const PoolShare& share) const noexcept
    {
        return room_.left_for(share);
    }

    /// Adds a face that the owner does not have; there must be room for it.
    [[nodiscard]] PrimId take(PoolShare& share, std::uint32_t owner,
                              const ActiveFace& face) noexcept
    {
        room_.take(share);
        TACTUS_ASSERT(!face.id.is_none());
        TACTUS_ASSERT(first_free_ < faces_.size());
        const PrimId prim{first_free_};
        TACTUS_ASSERT(faces_[prim.value].id.is_none());
        first_free_ = faces_[prim.value].corners[0].value;
        faces_[prim.value] = face;
        const bool inserted = index_list_.try_insert(face.id.value, prim.value, owner);
        TACTUS_ASSERT(inserted);
        return prim;
    }
    void give_back(PoolShare& share, std::uint32_t owner, PrimId prim) noexcept
    {
        room_.give_back(share);
        ActiveFace& face = faces_[prim.value];
        TACTUS_ASSERT(!face.id.is_none());
        index_list_.erase(face.id.value, owner);
        face = ActiveFace{};
        face.corners[0] = VertexId{first_free_};
        first_free_ = prim.value;
    }
    /// Slot of the owner's face; none if the owner has no such face.
    [[nodiscard]] PrimId find(FaceId face, std::uint32_t owner) const noexcept
    {
        return {index_list_.find(face.value, owner)};
    }

    [[nodiscard]] std::span<ActiveFace> faces() const noexcept { return faces_; }
    [[nodiscard]] std::uint32_t used() const noexcept { return room_.used(); }
    [[nodiscard]] std::uint32_t capacity() const noexcept { return room_.capacity(); }

private:
    friend class ForestValidator;

    static constexpr std::uint32_t kOwnerBits = std::bit_width(kMaxModels - 1);

    std::span<ActiveFace> faces_; ///< A free slot holds the next free one in its first corner.
    BasicIdTable<kOwnerBits> index_list_;
    PoolRoom room_;
    std::uint32_t first_free_{0};
};

} // namespace tactus
