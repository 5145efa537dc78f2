// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/spm/ids.hpp"

#include <array>
#include <cstdint>
#include <type_traits>

namespace tactus
{

/// State of a face: the record that last changed it and the face's place in that record's star. A
/// base face that no record has changed yet is in its base state.
struct FaceState
{
    static constexpr std::uint32_t kBaseValue = 0xFFFF'FFFFU;

    std::uint32_t value{kBaseValue};

    [[nodiscard]] static constexpr FaceState base() noexcept { return {}; }
    [[nodiscard]] static constexpr FaceState after(RecordId record, std::uint32_t place) noexcept
    {
        TACTUS_ASSERT(place < kMaxStarFaces);
        return {(record.value << 3U) | place};
    }
    [[nodiscard]] constexpr bool is_base() const noexcept { return value == kBaseValue; }
    /// The record that last changed the face; must not be called for a base state (asserted).
    [[nodiscard]] constexpr RecordId record() const noexcept
    {
        TACTUS_ASSERT(!is_base());
        return {value >> 3U};
    }
    [[nodiscard]] constexpr std::uint32_t place() const noexcept
    {
        TACTUS_ASSERT(!is_base());
        return value & 7U;
    }
    constexpr bool operator==(const FaceState&) const noexcept = default;
};

static_assert(kMaxStarFaces <= 8, "a place in a star is three bits of a FaceState");
static_assert(kMaxRecords <= FaceState::kBaseValue >> 3U, "no record's state is the base state");

/// One vsplit record in the forest's form.
///
/// Around the vanished vertex v, joined to its parent u, the star in canonical order is
///
///     A = (v, u, w0), fan faces (v, w0, w1) ... (v, wk-1, wk), B = (v, wk, u)
///
/// counter-clockwise round v. A and B are the faces that (re)appear with the split; on an open
/// border one of the two is missing, and both where v and u have no common edge (a pair
/// contraction). Before the split the fan is (u, wi, wi+1).
/// `star[0]` is A and `star[1]` is B (none when missing); the fan follows from `star[2]`, so a fan
/// face's place in the star is its index here.
///
/// Little-endian, fixed by golden bytes: encoder, parse, link and forest all touch it.
struct VsplitRecord
{
    Vec3f position_m{};                       ///< Position of v, model frame; exact.
    VertexId parent{};                        ///< Vertex u.
    std::array<FaceId, kMaxStarFaces> star{}; ///< Faces A, B, fan; none if missing.
    /// The record that splits this face next, after this record: `kNextExact` if the face is then
    /// exact, `kNextPending` until that record is linked. Both threads access it through
    /// std::atomic_ref; only the transport thread writes.
    std::array<std::uint32_t, kMaxStarFaces> next{};
    std::array<FaceState, kMaxFanFaces> before{}; ///< State of fan face i before this split.
    /// Error code of each star face after this split.
    std::array<std::uint8_t, kMaxStarFaces> error{};
    std::array<std::uint32_t, 2> bucket{}; ///< Ranks of A and B in left-full median order, >> 3.
    std::uint16_t depth{0};   ///< 1 + the largest depth of its dependencies; 1 on the base mesh.
    std::uint8_t fan_size{0}; ///< 1 .. kMaxFanFaces.
    std::uint8_t reach{0};    ///< Error code of the radius round v that holds star, fan and errors.
    std::uint32_t reserved{0}; ///< Zero; fills the record's two cache lines.

    [[nodiscard]] constexpr bool has_face(std::uint32_t side) const noexcept
    {
        TACTUS_ASSERT(side < 2);
        return !star[side].is_none();
    }
    /// One past the last used place of the star.
    [[nodiscard]] constexpr std::uint32_t star_end() const noexcept { return 2U + fan_size; }
};

inline constexpr std::uint32_t kNextExact = 0xFFFF'FFFFU;   ///< No record splits this face.
inline constexpr std::uint32_t kNextPending = 0xFFFF'FFFEU; ///< The record that splits it isn't
                                                            ///< resident yet.

static_assert(kMaxRecords <= kNextPending, "no record's id says exact or pending");
static_assert(sizeof(VsplitRecord) == 128 && std::is_trivially_copyable_v<VsplitRecord>);

/// One chunk's records, decoded.
struct Page
{
    std::array<VsplitRecord, kRecordsPerChunk> records;
};

static_assert(sizeof(Page) == 8192);

} // namespace tactus
