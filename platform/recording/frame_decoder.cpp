// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/frame_decoder.hpp"

#include "platform/recording/frame_encoder.hpp"
#include "platform/recording/setup_coding.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus
{

namespace
{

Budgets read_budgets(ByteReader& reader)
{
    Budgets budgets;
    for (std::uint32_t* budget :
         {&budgets.splits, &budgets.merges, &budgets.scanned, &budgets.nodes, &budgets.triangles,
          &budgets.pages, &budgets.requests, &budgets.regions, &budgets.planes, &budgets.work})
    {
        *budget = reader.read<std::uint32_t>();
    }
    return budgets;
}

} // namespace

void RecordedEdits::add(const SurfaceEdit& edit)
{
    Faces& faces = faces_.emplace_back();
    faces.removed.assign(edit.removed.begin(), edit.removed.end());
    faces.added.assign(edit.added.begin(), edit.added.end());
    SurfaceEdit& own = edits_.emplace_back(edit);
    own.removed = faces.removed;
    own.added = faces.added;
}

void RecordedEdits::clear() noexcept
{
    edits_.clear();
    faces_.clear();
}

RecordedEdits::RecordedEdits(const RecordedEdits& other)
{
    for (const SurfaceEdit& edit : other.edits_)
    {
        add(edit);
    }
}

RecordedEdits& RecordedEdits::operator=(const RecordedEdits& other)
{
    RecordedEdits copy(other);
    std::swap(*this, copy);
    return *this;
}

FrameDecoder::FrameDecoder(const FrameShape& shape)
{
    frame_.tools.resize(shape.tools);
    frame_.devices.resize(shape.tools);
    frame_.state_hashes.resize(shape.models);
}

const char* FrameDecoder::decode(ByteReader& reader)
{
    const auto bytes = reader.read<std::uint32_t>();
    ByteReader body(reader.read_bytes(bytes));
    if (reader.failed())
    {
        return "is cut short by the end of its section";
    }
    if (const char* fault = decode_body(body))
    {
        return fault;
    }
    return body.failed() || !body.at_end() ? "has a size that differs from its content" : nullptr;
}

const char* FrameDecoder::decode_body(ByteReader& reader)
{
    const auto flags = reader.read<std::uint8_t>();
    if (flags > (kHasChanges | kHasBudgets | kHasNoHashes | kHasEdits) ||
        (!has_begun_ && (flags & kHasBudgets) == 0))
    {
        return "has flags that are not 0 to 15, or no budgets in the first frame";
    }
    if (has_begun_ && !frame_.has_hashes && (flags & kHasNoHashes) == 0)
    {
        return "has hashes, but the frame before has none";
    }
    frame_.has_hashes = (flags & kHasNoHashes) == 0;
    has_begun_ = true;
    frame_.now_ns = reader.read<std::int64_t>();
    if (!decode_tools(reader))
    {
        return "has a tool whose flags do not match its data";
    }
    frame_.changes.clear();
    if ((flags & kHasChanges) != 0 && !decode_changes(reader))
    {
        return "does not have 1 to 64 changes of the scene, or has one of unknown kind";
    }
    frame_.edits.clear();
    if ((flags & kHasEdits) != 0)
    {
        if (const char* fault = decode_edits(reader))
        {
            return fault;
        }
    }
    if ((flags & kHasBudgets) != 0)
    {
        frame_.budgets = read_budgets(reader);
        if (frame_.budgets.splits > kMaxSplitsPerFrame ||
            frame_.budgets.merges > kMaxMergesPerFrame)
        {
            return "allows more than 256 splits or merges";
        }
    }
    if (const char* fault = decode_queue(reader))
    {
        return fault;
    }
    if (!frame_.has_hashes)
    {
        return nullptr;
    }
    for (std::uint64_t& hash : frame_.state_hashes)
    {
        hash = reader.read<std::uint64_t>();
    }
    for (std::uint64_t* hash :
         {&frame_.output.tools, &frame_.output.pairs, &frame_.output.models, &frame_.output.work})
    {
        *hash = reader.read<std::uint64_t>();
    }
    return nullptr;
}

const char* FrameDecoder::decode_queue(ByteReader& reader)
{
    frame_.request_room = reader.read<std::uint32_t>();
    const auto events = reader.read<std::uint16_t>();
    if (events > kMaxQueueEvents)
    {
        return "takes more than 128 events from the queues";
    }
    frame_.events.resize(events);
    for (QueueEvent& event : frame_.events)
    {
        const auto kind = reader.read<std::uint8_t>();
        const auto content = reader.read<std::uint8_t>();
        event.owner = reader.read<std::uint8_t>();
        event.key.number = reader.read<std::uint32_t>();
        event.slot = reader.read<std::uint32_t>();
        event.freed_taken = reader.read<std::uint32_t>();
        event.linked = reader.read<std::uint64_t>();
        event.kind = static_cast<QueueEventKind>(kind);
        event.key.kind = static_cast<ContentKind>(content);
        const bool is_known = event.kind == QueueEventKind::arrival
                                  ? event.key.kind == ContentKind::chunk ||
                                        event.key.kind == ContentKind::index_page ||
                                        event.key.kind == ContentKind::base
                                  : (event.kind == QueueEventKind::link_update &&
                                     event.key.kind == ContentKind::chunk) ||
                                        (event.kind == QueueEventKind::base_back &&
                                         event.key.kind == ContentKind::base);
        if (!reader.failed() && !is_known)
        {
            return "takes an event of unknown kind from the queues";
        }
    }
    return nullptr;
}

/// Reads the edits. The frame decides, as in the run, if they can be made.
const char* FrameDecoder::decode_edits(ByteReader& reader)
{
    constexpr const char* kFault = "does not have 1 or 2 edits, or has one of an unknown model, of "
                                   "more than 1024 faces or with a coordinate that is not finite";
    bool is_sound = true;
    const auto read_place = [&]
    {
        Vec3f place{};
        for (float& coordinate : place)
        {
            coordinate = reader.read<float>();
            is_sound = is_sound && std::isfinite(coordinate);
        }
        return place;
    };
    const auto edits = reader.read<std::uint8_t>();
    if (edits < 1 || edits > kMaxEditsPerFrame)
    {
        return kFault;
    }
    for (std::uint32_t i = 0; i < edits; ++i)
    {
        SurfaceEdit edit;
        edit.model = ModelId{reader.read<std::uint32_t>()};
        edit.revision = reader.read<std::uint32_t>();
        const std::uint32_t removed_count = reader.read<std::uint16_t>();
        const std::uint32_t added_count = reader.read<std::uint16_t>();
        if (edit.model.value >= frame_.state_hashes.size() || removed_count > kMaxEditFaces ||
            added_count > kMaxEditFaces)
        {
            return kFault;
        }
        edit.removed_m.low = read_place();
        edit.removed_m.high = read_place();
        std::vector<FaceId> removed(removed_count);
        std::vector<AddedFace> added(added_count);
        for (FaceId& face : removed)
        {
            face = FaceId{reader.read<std::uint32_t>()};
        }
        for (AddedFace& face : added)
        {
            face.slot = reader.read<std::uint32_t>();
            face.bucket = reader.read<std::uint32_t>();
            std::ranges::generate(face.corners_m, read_place);
        }
        edit.removed = removed;
        edit.added = added;
        frame_.edits.add(edit);
    }
    return is_sound ? nullptr : kFault;
}

bool FrameDecoder::decode_tools(ByteReader& reader)
{
    bool is_sound = true;
    for (std::size_t i = 0; i < frame_.tools.size(); ++i)
    {
        is_sound = try_read_tool(reader, frame_.tools[i], frame_.devices[i]) && is_sound;
    }
    return is_sound;
}

/// Reads the changes. The frame decides, as in the run, if they can be made.
bool FrameDecoder::decode_changes(ByteReader& reader)
{
    const auto changes = reader.read<std::uint8_t>();
    frame_.changes.resize(changes);
    return changes >= 1 && changes <= kMaxSceneChanges &&
           std::ranges::all_of(frame_.changes,
                               [&reader](SceneChange& change) { return try_read(reader, change); });
}

} // namespace tactus
