// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "tactus.h"

/// Samples of DDS as bytes: idlc's struct as it is in memory; then each of its sequences, in the
/// order of the struct, as a length of 2 bytes and the elements. The sequences of an element follow
/// its own.
namespace tactus::fuzz
{

enum class SampleKind : std::uint8_t
{
    catalogue_entry,
    object_record,
    motion,
    pieces,
    telemetry,
    edits,
    edit_requests,
};
inline constexpr std::size_t kSampleKinds = 7;

/// Calls `visit(sequence, bound)` for each sequence of a sample.
template <typename Visit>
void visit_sequences(tactus_v5_CatalogueEntry& /*sample*/, const Visit& /*visit*/)
{
}
template <typename Visit>
void visit_sequences(tactus_v5_ObjectRecord& /*sample*/, const Visit& /*visit*/)
{
}
template <typename Visit>
void visit_sequences(tactus_v5_Motion& sample, const Visit& visit)
{
    visit(sample.moved, tactus_v5_max_moved);
}
template <typename Visit>
void visit_sequences(tactus_v5_Pieces& sample, const Visit& visit)
{
    visit(sample.payload, tactus_v5_max_payload_bytes);
}
template <typename Visit>
void visit_sequences(tactus_v5_RefinementState& part, const Visit& visit)
{
    visit(part.tools, tactus_v5_max_tools);
    visit(part.models, tactus_v5_max_state_models);
    visit(part.chunks, tactus_v5_max_state_pages);
    visit(part.refined, tactus_v5_max_state_pages);
    visit(part.requested, tactus_v5_max_state_requests);
    visit(part.regions, tactus_v5_max_state_regions);
}
template <typename Visit>
void visit_sequences(tactus_v5_Telemetry& sample, const Visit& visit)
{
    visit(sample.tools, tactus_v5_max_tools);
    visit(sample.pairs, tactus_v5_max_pairs);
    visit(sample.models, tactus_v5_max_models);
    visit(sample.objects, tactus_v5_max_shown_objects);
    // The state's sequences follow it, since it is an element of a sequence.
    visit(sample.refinement_state, 1);
    if (sample.refinement_state._length > 0)
    {
        visit_sequences(sample.refinement_state._buffer[0], visit);
    }
}
template <typename Visit>
void visit_sequences(tactus_v5_Edits& sample, const Visit& visit)
{
    visit(sample.payload, tactus_v5_max_payload_bytes);
}
template <typename Visit>
void visit_sequences(tactus_v5_EditRequests& sample, const Visit& visit)
{
    visit(sample.hull, tactus_v5_max_hull_vertices);
}
template <typename Visit>
void visit_sequences(tactus_v5_Wanted& sample, const Visit& visit)
{
    visit(sample.pieces, tactus_v5_max_requests);
}

/// Makes what Cyclone promises of a sample true: a bounded string ends, and a bool is 0 or 1.
template <std::size_t Size>
void make_true(char (&text)[Size]) // NOLINT: idlc's type.
{
    text[Size - 1] = '\0';
}
inline void make_true(bool& flag)
{
    unsigned char byte = 0;
    std::memcpy(&byte, &flag, 1);
    flag = (byte & 1U) != 0;
}
template <typename Sample>
void make_true(Sample& /*sample*/)
{
    static_assert(std::is_class_v<Sample> || std::is_arithmetic_v<Sample>);
}
inline void make_true(tactus_v5_CatalogueEntry& entry)
{
    make_true(entry.name);
    make_true(entry.scene);
}
inline void make_true(tactus_v5_ObjectRecord& record)
{
    make_true(record.name);
}
inline void make_true(tactus_v5_Pieces& pieces)
{
    make_true(pieces.lets_in);
}
inline void make_true(tactus_v5_ModelTelemetry& model)
{
    make_true(model.name);
}
inline void make_true(tactus_v5_ObjectTelemetry& object)
{
    make_true(object.name);
}
inline void make_true(tactus_v5_Telemetry& telemetry)
{
    make_true(telemetry.controller_name);
}
inline void make_true(tactus_v5_RefinementStateTool& tool)
{
    make_true(tool.shape);
    make_true(tool.begins_inside);
}
inline void make_true(tactus_v5_RefinementStateRegion& region)
{
    make_true(region.is_predicted);
}
inline void make_true(tactus_v5_Wanted& wanted)
{
    make_true(wanted.controller_name);
}

/// Reads samples from bytes; those past the end are 0. It owns their sequences, each of which has
/// its exact size, so that reads beyond the end are detected.
class SampleReader
{
public:
    explicit SampleReader(std::span<const std::byte> bytes) : left_(bytes) {}

    template <typename Value>
    [[nodiscard]] Value read()
    {
        static_assert(std::is_trivially_copyable_v<Value>);
        Value value;
        std::memset(&value, 0, sizeof(value));
        const std::size_t size = std::min(sizeof(value), left_.size());
        std::copy_n(left_.begin(), size, reinterpret_cast<std::byte*>(&value));
        left_ = left_.subspan(size);
        make_true(value);
        return value;
    }
    template <typename Sample>
    [[nodiscard]] Sample read_sample()
    {
        auto sample = read<Sample>();
        visit_sequences(sample, [this](auto& sequence, std::size_t bound)
                        { this->read_sequence(sequence, bound); });
        return sample;
    }

private:
    template <typename Sequence>
    void read_sequence(Sequence& sequence, std::size_t bound)
    {
        using Element = std::remove_pointer_t<decltype(sequence._buffer)>;
        const std::size_t length = std::min<std::size_t>(read<std::uint16_t>(), bound);
        auto& elements = owned_.emplace_back(new std::byte[length * sizeof(Element)]);
        sequence._buffer = reinterpret_cast<Element*>(elements.get());
        sequence._maximum = sequence._length = static_cast<std::uint32_t>(length);
        sequence._release = false;
        for (std::size_t i = 0; i < length; ++i)
        {
            const auto element = read<Element>();
            std::memcpy(sequence._buffer + i, &element, sizeof(element));
        }
    }

    std::span<const std::byte> left_;
    std::vector<std::unique_ptr<std::byte[]>> owned_; // NOLINT: its size is exact.
};

/// A sample, or an element of a sequence, without the addresses in it.
template <typename Sample>
[[nodiscard]] Sample without_sequences(Sample sample)
{
    const auto clear = [](auto& sequence, std::size_t /*bound*/)
    { std::memset(&sequence, 0, sizeof(sequence)); };
    if constexpr (requires { visit_sequences(sample, clear); })
    {
        visit_sequences(sample, clear);
    }
    return sample;
}

/// Appends the bytes of a sample, as SampleReader reads them. All padding of `sample` must be 0.
template <typename Sample>
void append_sample(std::vector<std::byte>& script, Sample sample)
{
    const auto put = [&](const auto& value)
    {
        const auto* bytes = reinterpret_cast<const std::byte*>(&value);
        script.insert(script.end(), bytes, bytes + sizeof(value));
    };
    put(without_sequences(sample));
    visit_sequences(sample,
                    [&](auto& sequence, std::size_t /*bound*/)
                    {
                        put(static_cast<std::uint16_t>(sequence._length));
                        for (std::uint32_t i = 0; i < sequence._length; ++i)
                        {
                            put(without_sequences(sequence._buffer[i]));
                        }
                    });
}

/// The number of a kind, and a sample of that kind.
template <typename Sample>
[[nodiscard]] std::vector<std::byte> sample_script(SampleKind kind, const Sample& sample)
{
    std::vector<std::byte> script{static_cast<std::byte>(kind)};
    append_sample(script, sample);
    return script;
}

} // namespace tactus::fuzz
