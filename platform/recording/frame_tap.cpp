// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/frame_tap.hpp"

#include <algorithm>
#include <cstring>

namespace tactus
{

FrameTap::FrameTap(std::size_t cells) : cells_(cells), queue_(cells_) {}

void FrameTap::record(const FrameInput& input, const FrameOutput& output,
                      std::span<const DeviceRecord> devices) noexcept
{
    if (lost_from_.load(std::memory_order_relaxed) == kNoFrame) // Only this thread writes it.
    {
        put(encoder_.encode(input, output, devices));
    }
}

void FrameTap::record_failed(const GivenFrame& frame) noexcept
{
    if (lost_from_.load(std::memory_order_relaxed) == kNoFrame)
    {
        put(encoder_.encode_given(frame));
    }
}

void FrameTap::put(std::span<const std::byte> coded) noexcept
{
    const std::size_t needed = (coded.size() + sizeof(Cell) - 1) / sizeof(Cell);
    if (queue_.capacity() - queue_.size() < needed)
    {
        lost_from_.store(frames_, std::memory_order_relaxed); // Relaxed, see lost_from().
        return;
    }
    ++frames_;
    for (; !coded.empty(); coded = coded.subspan(std::min(coded.size(), sizeof(Cell))))
    {
        Cell cell{};
        std::memcpy(cell.data(), coded.data(), std::min(coded.size(), sizeof(Cell)));
        const bool pushed = queue_.try_push(cell);
        TACTUS_ASSERT(pushed);
    }
}

bool FrameTap::try_take(std::vector<std::byte>& frame)
{
    Cell cell;
    if (!queue_.try_pop(cell))
    {
        return false;
    }
    std::uint32_t body = 0;
    std::memcpy(&body, cell.data(), sizeof(body));
    frame.assign(cell.begin(), cell.end());
    const std::size_t size = sizeof(body) + body;
    while (frame.size() < size)
    {
        if (queue_.try_pop(cell)) // The rest of a frame follows at once.
        {
            frame.insert(frame.end(), cell.begin(), cell.end());
        }
    }
    frame.resize(size);
    return true;
}

} // namespace tactus
