// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/core_coding.hpp"
#include "rt_core/frame/frame.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

// Any thread, but not the haptic one: values; their texts and bytes allocate.
namespace tactus
{

/// docs/recording.md describes the file.
inline constexpr std::array<char, 8> kRecordingMagic{'T', 'A', 'C', 'T', 'R', 'E', 'C', '\n'};
inline constexpr std::uint32_t kRecordingVersion = 12;
inline constexpr std::size_t kRecordingPrologueBytes = 12;

enum class SectionKind : std::uint32_t
{
    setup = 1,
    model = 2,
    piece = 3,
    frames = 4,
    end = 5,
    name = 6,
};

/// In front of every section: kind, payload bytes, CRC-32C of those two and the payload.
inline constexpr std::size_t kSectionHeaderBytes = 12;
/// A longer frames section is never written, so a damaged length is seen as such.
inline constexpr std::uint32_t kMaxFramesSectionBytes = 1U << 20U;

/// A model as it was when the frame was made.
struct RecordedModel
{
    ModelCapacities capacities;
    std::vector<std::byte> header; ///< Coded, as ModelSource takes them.
    std::vector<std::byte> base;   ///< Empty: a guest, which comes and goes.
};

/// What people call it: a model, or an object under its number and of one generation.
struct RecordedName
{
    enum class Kind : std::uint8_t
    {
        model = 0,
        object = 1,
    };
    Kind kind{Kind::model};
    std::uint32_t number{0};
    std::uint32_t generation{0}; ///< Of a model 0.

    auto operator<=>(const RecordedName&) const noexcept = default;
};

/// What the frame was made of.
struct RecordedSetup
{
    std::int64_t period_ns{1'000'000};
    std::int64_t pose_age_max_ns{100'000'000};
    bool static_when_it_fits{false};
    Prediction prediction{Prediction::automatic};
    double force_tolerance_n{0.0};
    std::vector<ToolSpec> tools;
    HullVertices hull_vertices; ///< Of tools that were read from a recording.
    std::vector<ObjectSpec> objects;
    std::vector<ObjectPose> poses; ///< One an object.
    SceneCapacities capacities;
    ModelCapacities for_guests;
    std::vector<RecordedModel> models;
    /// Of what has one, also of objects that come later; at most kMaxRecordedNameBytes each.
    std::map<RecordedName, std::string> names;
    /// For the reader of a difference: how the program that recorded was built, and the kernels it
    /// ran. At most kMaxRecordedNameBytes each.
    std::string compiler;
    std::string architecture;
    std::string kernels;

    /// Empty: it has none.
    [[nodiscard]] std::string name_of(const RecordedName& what) const
    {
        const auto found = names.find(what);
        return found == names.end() ? std::string() : found->second;
    }
};

inline constexpr std::size_t kMaxRecordedNameBytes = 63;
/// No host serves a larger base mesh.
inline constexpr std::size_t kMaxRecordedBaseBytes = std::size_t{1} << 20U;
/// As much as `hrtc --pool-mib` can be; a recording that needs more was never made.
inline constexpr std::size_t kMaxRecordedPoolBytes = std::size_t{4'096} << 20U;

/// No frame was lost.
inline constexpr std::uint64_t kNoFrame = std::numeric_limits<std::uint64_t>::max();

/// How this program was built: compiler and whether it optimised, processor.
[[nodiscard]] std::string this_build();

/// The setup of a frame that this program makes, as a recording keeps it: copies all of it but the
/// vertices of hulls.
[[nodiscard]] RecordedSetup to_recorded(const FrameSetup& setup);

} // namespace tactus
