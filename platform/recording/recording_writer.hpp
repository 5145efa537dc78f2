// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/recording_format.hpp"
#include "rt_core/spm/content_key.hpp"

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

namespace tactus
{

/// Formats a recording's bytes in the order of the calls; the owner takes and stores them. A piece
/// must be added before the frame that takes it. One thread, not the haptic one: it allocates. It
/// keeps all bytes until take_bytes().
class RecordingWriter
{
public:
    explicit RecordingWriter(const RecordedSetup& setup);

    /// Adds a name of a model or object, at any time.
    void add_name(const RecordedName& what, std::string_view name);

    /// Adds a coded chunk, index page or base mesh of one of the setup's models. A second piece
    /// under the same key must be the same, and is left out.
    void add_piece(std::uint32_t model, ContentKey key, std::span<const std::byte> bytes);

    /// Adds one frame as coded by FrameEncoder.
    void add_frame(std::span<const std::byte> coded);

    /// Closes the recording, once, as the last call except take_bytes(). `lost_from`: the first
    /// frame that was lost; kNoFrame: none.
    void finish(std::uint64_t lost_from);

    [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
    /// Returns all bytes formatted since the last call.
    [[nodiscard]] std::vector<std::byte> take_bytes();

private:
    void close_frames();
    void append_section(SectionKind kind, std::span<const std::byte> payload);

    std::vector<std::byte> bytes_;
    std::vector<std::byte> open_frames_; ///< Frames of the section that is not full yet.
    std::set<std::tuple<std::uint32_t, ContentKind, std::uint32_t>> pieces_;
    std::uint64_t frames_{0};
};

} // namespace tactus
