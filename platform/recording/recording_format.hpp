// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/byte_io.hpp"
#include "rt_core/frame/frame_setup.hpp"
#include "rt_core/frame/model_capacities.hpp"
#include "rt_core/geometry/tool_core.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/object_pose.hpp"
#include "rt_core/records/prediction.hpp"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// Any thread, but not the haptic one: values; their texts and bytes allocate.
namespace tactus
{

/// Vertices of a recording's hulls; copies share them.
using HullVertices = std::vector<std::shared_ptr<const std::vector<Vec3>>>;

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

/// Size of a section's header: kind, payload bytes, CRC-32C of those two and the payload.
inline constexpr std::size_t kSectionHeaderBytes = 12;
/// Most bytes of a frames section, so that a damaged length is detected.
inline constexpr std::uint32_t kMaxFramesSectionBytes = 1U << 20U;

/// Model as it was given to the frame at the start of the run.
struct RecordedModel
{
    ModelCapacities capacities;
    std::vector<std::byte> header; ///< Coded header, as ModelSource takes it.
    std::vector<std::byte> base;   ///< Coded base mesh; empty: a streamed model.
};

/// Key of a name: a model by its number, or an object by number and generation.
struct RecordedName
{
    enum class Kind : std::uint8_t
    {
        model = 0,
        object = 1,
    };
    Kind kind{Kind::model};
    std::uint32_t number{0};
    std::uint32_t generation{0}; ///< Generation; 0 for a model.

    auto operator<=>(const RecordedName&) const noexcept = default;
};

/// Set-up of the frame at the start of the run, with the program that recorded it.
struct RecordedSetup
{
    std::int64_t period_ns{1'000'000};
    std::int64_t pose_age_max_ns{100'000'000};
    bool static_when_it_fits{false};
    Prediction prediction{Prediction::automatic};
    double force_tolerance_n{0.0};
    std::vector<ToolSpec> tools;
    HullVertices hull_vertices; ///< Owner of the hull vertices in `tools`, if read from a file.
    std::vector<ObjectSpec> objects;
    std::vector<ObjectPose> poses; ///< Poses, one an object.
    SceneCapacities capacities;
    ModelCapacities for_streamed_models;
    std::vector<RecordedModel> models;
    /// Names of models and objects, also of objects added later; at most kMaxRecordedNameBytes
    /// each.
    std::map<RecordedName, std::string> names;
    /// Build and kernels of the recording program, to explain a difference; at most
    /// kMaxRecordedNameBytes each.
    std::string compiler;
    std::string architecture;
    std::string kernels;

    /// Name of a model or object; empty if there is none.
    [[nodiscard]] std::string name_of(const RecordedName& what) const
    {
        const auto found = names.find(what);
        return found == names.end() ? std::string() : found->second;
    }
};

inline constexpr std::size_t kMaxRecordedNameBytes = 63;
/// Size of the largest base mesh that a server serves.
inline constexpr std::size_t kMaxRecordedBaseBytes = std::size_t{1} << 20U;
/// Largest `hrtc --pool-mib`; a recording that needs more is damaged.
inline constexpr std::size_t kMaxRecordedPoolBytes = std::size_t{4'096} << 20U;

/// Value of Recording::lost_from() if no frame was lost.
inline constexpr std::uint64_t kNoFrame = std::numeric_limits<std::uint64_t>::max();

/// Build of this program: compiler and optimisation, processor.
[[nodiscard]] std::string this_build();

/// Set-up of a frame of this program in a recording's form: copies all of it except the vertices of
/// hulls.
[[nodiscard]] RecordedSetup to_recorded(const FrameSetup& setup);

/// Appends a tool's core: a byte for its kind, and its numbers (docs/recording.md). A core given
/// only by a support function can't be coded, since the function is code (asserted).
void append_core(std::vector<std::byte>& bytes, const ToolCore& core);

/// Reads a core. None if the kind is unknown, a length is not within -1e6 to 1e6 m, or a hull has
/// not 1 to kMaxHullVertices vertices. A hull's vertices are added to `vertices`.
[[nodiscard]] std::optional<ToolCore> read_core(ByteReader& reader, HullVertices& vertices);

/// 64-bit hashes of the parts of a FrameOutput, over all bits of every field, without padding.
/// Frames with equal hashes have given the same values.
struct OutputHashes
{
    std::uint64_t tools{0};
    std::uint64_t pairs{0};
    std::uint64_t models{0}; ///< Hash of pools, refined records and state hash of each model.
    std::uint64_t work{0};   ///< Hash of work counters, scene and faults.

    bool operator==(const OutputHashes&) const noexcept = default;
};

/// Hashes the output. About 60 multiplications for one tool and one object. `output.queues` is an
/// input and left out.
[[nodiscard]] OutputHashes hash_output(const FrameOutput& output) noexcept;

} // namespace tactus
