// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/frame_encoder.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

void write_budgets(FixedWriter& writer, const Budgets& budgets) noexcept
{
    for (const std::uint32_t budget :
         {budgets.splits, budgets.merges, budgets.scanned, budgets.nodes, budgets.triangles,
          budgets.pages, budgets.requests, budgets.regions, budgets.planes, budgets.work})
    {
        writer.write(budget);
    }
}

void write_queue(FixedWriter& writer, const QueueTake& queues) noexcept
{
    writer.write(queues.request_room);
    writer.write(static_cast<std::uint16_t>(queues.events.size()));
    for (const QueueEvent& event : queues.events)
    {
        writer.write(static_cast<std::uint8_t>(event.kind));
        writer.write(static_cast<std::uint8_t>(event.key.kind));
        writer.write(event.owner);
        writer.write(event.key.number);
        writer.write(event.slot);
        writer.write(event.freed_taken);
        writer.write(event.linked);
    }
}

void write_edit(FixedWriter& writer, const SurfaceEdit& edit) noexcept
{
    TACTUS_ASSERT(edit.removed.size() <= kMaxEditFaces);
    TACTUS_ASSERT(edit.added.size() <= kMaxEditFaces);
    const auto write_all = [&](const Vec3f& place)
    { std::ranges::for_each(place, [&](float coordinate) { writer.write(coordinate); }); };
    writer.write(edit.model.value);
    writer.write(edit.revision);
    writer.write(static_cast<std::uint16_t>(edit.removed.size()));
    writer.write(static_cast<std::uint16_t>(edit.added.size()));
    write_all(edit.removed_m.low);
    write_all(edit.removed_m.high);
    for (const FaceId face : edit.removed)
    {
        writer.write(face.value);
    }
    for (const AddedFace& face : edit.added)
    {
        writer.write(face.slot);
        writer.write(face.bucket);
        std::ranges::for_each(face.corners_m, write_all);
    }
}

/// Copies `now` over `last`; true if they differed.
bool try_update(std::span<const std::byte> now, std::span<std::byte> last) noexcept
{
    if (std::equal(now.begin(), now.end(), last.begin()))
    {
        return false;
    }
    std::copy(now.begin(), now.end(), last.begin());
    return true;
}

} // namespace

std::span<const std::byte> FrameEncoder::encode(const FrameInput& input, const FrameOutput& output,
                                                std::span<const DeviceRecord> devices) noexcept
{
    FixedWriter writer = begin({input, output.queues, devices}, 0);
    for (const ModelOutput& model : output.models)
    {
        writer.write(model.state_hash);
    }
    const OutputHashes hashes = hash_output(output);
    for (const std::uint64_t hash : {hashes.tools, hashes.pairs, hashes.models, hashes.work})
    {
        writer.write(hash);
    }
    return end(writer);
}

std::span<const std::byte> FrameEncoder::encode_given(const GivenFrame& frame) noexcept
{
    return end(begin(frame, kHasNoHashes | kHasBudgets));
}

/// Writes everything except the hashes.
FixedWriter FrameEncoder::begin(const GivenFrame& frame, std::uint8_t flags) noexcept
{
    const auto& [input, queues, devices] = frame;
    TACTUS_ASSERT(devices.empty() || devices.size() == input.tools.size());
    TACTUS_ASSERT(input.changes.size() <= kMaxSceneChanges);
    TACTUS_ASSERT(input.edits.size() <= kMaxEditsPerFrame);
    std::array<std::byte, kBudgetsBytes> coded_budgets;
    FixedWriter budget_writer(coded_budgets);
    write_budgets(budget_writer, input.budgets);
    const bool has_changes = !input.changes.empty();
    const bool has_budgets =
        try_update(coded_budgets, budgets_) || !has_begun_ || (flags & kHasBudgets) != 0;
    has_begun_ = true;

    FixedWriter writer{std::span(bytes_).subspan(sizeof(std::uint32_t))};
    writer.write(static_cast<std::uint8_t>(flags | (has_changes ? kHasChanges : 0) |
                                           (has_budgets ? kHasBudgets : 0) |
                                           (input.edits.empty() ? 0 : kHasEdits)));
    writer.write(input.now_ns);
    for (std::size_t i = 0; i < input.tools.size(); ++i)
    {
        write_tool(writer, input.tools[i], devices.empty() ? DeviceRecord{} : devices[i]);
    }
    if (has_changes)
    {
        writer.write(static_cast<std::uint8_t>(input.changes.size()));
    }
    for (const SceneChange& change : input.changes)
    {
        write_change(writer, change);
    }
    if (!input.edits.empty())
    {
        writer.write(static_cast<std::uint8_t>(input.edits.size()));
    }
    for (const SurfaceEdit& edit : input.edits)
    {
        write_edit(writer, edit);
    }
    writer.write_bytes(has_budgets ? std::span<const std::byte>(coded_budgets)
                                   : std::span<const std::byte>{});
    write_queue(writer, queues);
    return writer;
}

/// Writes the size in front of the frame.
std::span<const std::byte> FrameEncoder::end(const FixedWriter& writer) noexcept
{
    FixedWriter(bytes_).write(static_cast<std::uint32_t>(writer.size()));
    return std::span<const std::byte>(bytes_).first(sizeof(std::uint32_t) + writer.size());
}

} // namespace tactus
