// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/frame_decoder.hpp"
#include "platform/recording/recording_format.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/spm/content_key.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

// Any thread, but not the haptic one: reading allocates and waits for the file. A recording may be
// used by several threads at once.
namespace tactus
{

/// A recording in memory, checked as a whole: every section's checksum, every count and range, and
/// that each piece that a frame takes from the door is there before it. Of a file that was cut,
/// since its program was killed or its copy ended, it has the frames up to the last whole section.
class Recording
{
public:
    /// Reads a file, whole; it takes as much memory as the file has bytes. Refused in one line with
    /// the file's name.
    [[nodiscard]] static Result<Recording, Refusal> read(const std::string& path);
    /// The same for bytes in memory; `name` stands for the file's in messages.
    [[nodiscard]] static Result<Recording, Refusal> parse(std::span<const std::byte> bytes,
                                                          const std::string& name);

    /// All that is returned by reference or as a span is the recording's.
    [[nodiscard]] const RecordedSetup& setup() const noexcept { return setup_; }
    /// For a FrameDecoder.
    [[nodiscard]] FrameShape shape() const noexcept
    {
        return {setup_.tools.size(), setup_.models.size()};
    }
    /// The coded piece; empty when the recording has none under this key.
    [[nodiscard]] std::span<const std::byte> piece(std::uint32_t model,
                                                   ContentKey key) const noexcept;
    /// All frames as FrameEncoder coded them, for a FrameDecoder.
    [[nodiscard]] std::span<const std::byte> frames() const noexcept { return frames_; }
    [[nodiscard]] std::uint64_t frame_count() const noexcept { return frame_count_; }
    /// False: it keeps what the last frames of a run that failed were given, and can't be replayed.
    [[nodiscard]] bool keeps_run() const noexcept { return failed_frames_ <= 1; }
    /// The last frame failed in the run.
    [[nodiscard]] bool has_failed() const noexcept { return failed_frames_ > 0; }
    /// The first frame that the recorder lost; kNoFrame when it lost none.
    [[nodiscard]] std::uint64_t lost_from() const noexcept { return lost_from_; }
    /// The byte at which the file was cut; none when it is whole.
    [[nodiscard]] std::optional<std::size_t> cut_at() const noexcept { return cut_at_; }
    /// What of the run is missing behind the last frame, in one clause; empty: nothing.
    [[nodiscard]] std::string missing() const;

private:
    friend class RecordingParser;
    using PieceKey = std::tuple<std::uint32_t, ContentKind, std::uint32_t>;

    RecordedSetup setup_;
    std::map<PieceKey, std::vector<std::byte>> pieces_;
    std::vector<std::byte> frames_;
    std::uint64_t frame_count_{0};
    std::uint64_t failed_frames_{0}; ///< Without hashes: the last ones.
    std::uint64_t lost_from_{kNoFrame};
    std::optional<std::size_t> cut_at_;
};

} // namespace tactus
