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

/// A recording in memory. Parsing has checked every section's checksum, every count and range, and
/// that each piece precedes the frame that takes it. If the file was truncated, it has the frames
/// up to the last whole section.
class Recording
{
public:
    /// Reads a whole file; takes as much memory as the file's size. Refused in one line with the
    /// file's name.
    [[nodiscard]] static Result<Recording, Refusal> read(const std::string& path);
    /// Parses bytes in memory; `name` replaces the file's in messages.
    [[nodiscard]] static Result<Recording, Refusal> parse(std::span<const std::byte> bytes,
                                                          const std::string& name);

    /// References and spans returned here and below are valid as long as the recording.
    [[nodiscard]] const RecordedSetup& setup() const noexcept { return setup_; }
    /// Shape for a FrameDecoder.
    [[nodiscard]] FrameShape shape() const noexcept
    {
        return {setup_.tools.size(), setup_.models.size()};
    }
    /// Coded piece; empty if the recording has none under this key.
    [[nodiscard]] std::span<const std::byte> piece(std::uint32_t model,
                                                   ContentKey key) const noexcept;
    /// All frames as coded by FrameEncoder, for a FrameDecoder.
    [[nodiscard]] std::span<const std::byte> frames() const noexcept { return frames_; }
    [[nodiscard]] std::uint64_t frame_count() const noexcept { return frame_count_; }
    /// False if it keeps only the input of the last frames of a failed run, and can't be replayed.
    [[nodiscard]] bool keeps_run() const noexcept { return failed_frames_ <= 1; }
    /// True if the last frame failed in the run.
    [[nodiscard]] bool has_failed() const noexcept { return failed_frames_ > 0; }
    /// First frame that the recorder lost; kNoFrame if none.
    [[nodiscard]] std::uint64_t lost_from() const noexcept { return lost_from_; }
    /// Byte at which the file was truncated; none if it is whole.
    [[nodiscard]] std::optional<std::size_t> cut_at() const noexcept { return cut_at_; }
    /// Part of the run that is missing after the last frame, in one clause; empty: none.
    [[nodiscard]] std::string missing() const;

private:
    friend class RecordingParser;
    using PieceKey = std::tuple<std::uint32_t, ContentKind, std::uint32_t>;

    RecordedSetup setup_;
    std::map<PieceKey, std::vector<std::byte>> pieces_;
    std::vector<std::byte> frames_;
    std::uint64_t frame_count_{0};
    std::uint64_t failed_frames_{0}; ///< Number of frames without hashes, all at the end.
    std::uint64_t lost_from_{kNoFrame};
    std::optional<std::size_t> cut_at_;
};

} // namespace tactus
