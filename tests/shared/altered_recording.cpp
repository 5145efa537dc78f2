// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/altered_recording.hpp"

#include "platform/recording/recording_writer.hpp"

#include <cstring>

namespace tactus::test
{

namespace
{

void copy_pieces(const Recording& recording, RecordingWriter& writer)
{
    for (std::uint32_t i = 0; i < recording.setup().models.size(); ++i)
    {
        const ModelCounts counts =
            ModelHeader::parse(recording.setup().models[i].header).value().counts();
        const auto copy = [&](ContentKind kind, std::uint32_t end)
        {
            for (std::uint32_t number = 0; number < end; ++number)
            {
                if (const auto piece = recording.piece(i, {kind, number}); !piece.empty())
                {
                    writer.add_piece(i, {kind, number}, piece);
                }
            }
        };
        copy(ContentKind::index_page, counts.index_pages());
        copy(ContentKind::chunk, counts.chunks());
    }
}

} // namespace

std::vector<std::byte> alter_frame(const Recording& recording, std::uint64_t frame,
                                   const std::function<void(std::span<std::byte>)>& change)
{
    RecordingWriter writer(recording.setup());
    copy_pieces(recording, writer);
    ByteReader reader(recording.frames());
    for (std::uint64_t i = 0; !reader.at_end(); ++i)
    {
        const auto size = reader.read<std::uint32_t>();
        const auto body = reader.read_bytes(size);
        std::vector<std::byte> coded(sizeof(size));
        std::memcpy(coded.data(), &size, sizeof(size));
        coded.insert(coded.end(), body.begin(), body.end());
        if (i == frame)
        {
            change(coded);
        }
        writer.add_frame(coded);
    }
    writer.finish(recording.lost_from());
    return writer.take_bytes();
}

void change_goal(std::span<std::byte> coded_frame)
{
    // Offset after the frame's size, flags and time; the lowest bit of the exponent.
    coded_frame[4 + 1 + 8 + 6] ^= std::byte{0x10};
}

} // namespace tactus::test
