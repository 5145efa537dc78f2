// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/math/vec3.hpp"
#include "tests/shared/random.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::test
{

/// Aligned memory for an arena.
class ArenaMemory
{
public:
    explicit ArenaMemory(std::size_t bytes) : lines_(bytes / Arena::kAlignment + 1) {}

    [[nodiscard]] std::span<std::byte> bytes() noexcept
    {
        return std::as_writable_bytes(std::span(lines_));
    }

private:
    struct alignas(Arena::kAlignment) Line
    {
        std::byte bytes[Arena::kAlignment];
    };

    std::vector<Line> lines_;
};

[[nodiscard]] inline Vec3f to_float(const Vec3& v)
{
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

} // namespace tactus::test
