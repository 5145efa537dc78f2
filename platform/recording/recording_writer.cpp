// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/recording_writer.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/base/crc32c.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace tactus
{

namespace
{

/// Frames are gathered into sections of about this size, so that a section's frame is small.
constexpr std::size_t kFramesSectionBytes = std::size_t{64} << 10U;

template <typename T>
void append(std::vector<std::byte>& bytes, const T& value)
{
    static_assert(std::is_arithmetic_v<T>);
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof(T));
}

void append_bytes(std::vector<std::byte>& bytes, std::span<const std::byte> more)
{
    bytes.insert(bytes.end(), more.begin(), more.end());
}

void append_name(std::vector<std::byte>& bytes, const std::string& name)
{
    const std::string_view kept = std::string_view(name).substr(0, kMaxRecordedNameBytes);
    append(bytes, static_cast<std::uint8_t>(kept.size()));
    append_bytes(bytes, std::as_bytes(std::span(kept)));
}

std::vector<std::byte> code_setup(const RecordedSetup& setup)
{
    std::vector<std::byte> bytes;
    append(bytes, setup.period_ns);
    append(bytes, setup.pose_age_max_ns);
    append(bytes, static_cast<std::uint8_t>(setup.static_when_it_fits));
    append(bytes, static_cast<std::uint8_t>(setup.tools.size()));
    append(bytes, static_cast<std::uint8_t>(setup.objects.size()));
    append(bytes, static_cast<std::uint8_t>(setup.models.size()));
    for (const ToolSpec& tool : setup.tools)
    {
        append(bytes, tool.radius_m);
        append(bytes, tool.stiffness_n_per_m);
        append(bytes, tool.force_max_n);
        append(bytes, tool.speed_max_m_per_s);
    }
    for (const ObjectSpec& object : setup.objects)
    {
        append(bytes, object.model.value);
    }
    append_name(bytes, setup.compiler);
    append_name(bytes, setup.architecture);
    append_name(bytes, setup.kernels);
    return bytes;
}

std::vector<std::byte> code_model(const RecordedModel& model)
{
    std::vector<std::byte> bytes;
    const ModelCapacities& capacities = model.capacities;
    for (const std::uint32_t capacity : {capacities.pages, capacities.index_pages, capacities.faces,
                                         capacities.blocks, capacities.nodes})
    {
        append(bytes, capacity);
    }
    append(bytes, static_cast<std::uint8_t>(capacities.cache_off));
    append(bytes, static_cast<std::uint32_t>(model.header.size()));
    append_bytes(bytes, model.header);
    append_bytes(bytes, model.base);
    return bytes;
}

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
    // The checksum stands in front of the payload but is of both.
    const std::uint32_t checksum = crc32c(std::span(bytes_).subspan(start));
    const auto* first = reinterpret_cast<const std::byte*>(&checksum);
    bytes_.insert(bytes_.begin() + static_cast<std::ptrdiff_t>(start + 8), first,
                  first + sizeof(checksum));
}

} // namespace tactus
