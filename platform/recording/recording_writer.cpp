// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/recording_writer.hpp"

#include "platform/recording/fixed_writer.hpp"
#include "platform/recording/setup_coding.hpp"
#include "rt_core/base/crc32c.hpp"

#include <utility>

namespace tactus
{

namespace
{

/// Frames are gathered into sections of about this size, so that a section's overhead is small.
constexpr std::size_t kFramesSectionBytes = std::size_t{64} << 10U;

} // namespace

RecordingWriter::RecordingWriter(const RecordedSetup& setup)
{
    append_bytes(bytes_, std::as_bytes(std::span(kRecordingMagic)));
    append(bytes_, kRecordingVersion);
    append_section(SectionKind::setup, code_setup(setup));
    for (const RecordedModel& model : setup.models)
    {
        append_section(SectionKind::model, code_model(model));
    }
    for (const auto& [what, name] : setup.names)
    {
        add_name(what, name);
    }
}

void RecordingWriter::add_name(const RecordedName& what, std::string_view name)
{
    append_section(SectionKind::name, code_name(what, name));
}

void RecordingWriter::add_piece(std::uint32_t model, ContentKey key,
                                std::span<const std::byte> bytes)
{
    if (!pieces_.emplace(model, key.kind, key.number).second)
    {
        return;
    }
    std::vector<std::byte> payload;
    append(payload, static_cast<std::uint8_t>(model));
    append(payload, static_cast<std::uint8_t>(key.kind));
    append(payload, key.number);
    append_bytes(payload, bytes);
    append_section(SectionKind::piece, payload);
}

void RecordingWriter::add_frame(std::span<const std::byte> coded)
{
    append_bytes(open_frames_, coded);
    ++frames_;
    if (open_frames_.size() >= kFramesSectionBytes)
    {
        close_frames();
    }
}

void RecordingWriter::finish(std::uint64_t lost_from)
{
    close_frames();
    std::vector<std::byte> payload;
    append(payload, frames_);
    append(payload, lost_from);
    append(payload, static_cast<std::uint64_t>(pieces_.size()));
    append_section(SectionKind::end, payload);
}

std::vector<std::byte> RecordingWriter::take_bytes()
{
    return std::exchange(bytes_, {});
}

void RecordingWriter::close_frames()
{
    if (!open_frames_.empty())
    {
        append_section(SectionKind::frames, open_frames_);
        open_frames_.clear();
    }
}

void RecordingWriter::append_section(SectionKind kind, std::span<const std::byte> payload)
{
    const std::size_t start = bytes_.size();
    append(bytes_, static_cast<std::uint32_t>(kind));
    append(bytes_, static_cast<std::uint32_t>(payload.size()));
    append_bytes(bytes_, payload);
    // The checksum is in front of the payload but covers both.
    const std::uint32_t checksum = crc32c(std::span(bytes_).subspan(start));
    const auto* first = reinterpret_cast<const std::byte*>(&checksum);
    bytes_.insert(bytes_.begin() + static_cast<std::ptrdiff_t>(start + 8), first,
                  first + sizeof(checksum));
}

} // namespace tactus
