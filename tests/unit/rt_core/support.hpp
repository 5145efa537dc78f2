// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/math/vec3.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <span>
#include <vector>

namespace tactus::test
{

/// Memory for an arena, on the boundary that it asks for.
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

/// Random numbers of one test. The seed is printed; the environment variable TACTUS_SEED sets
/// it.
class Random
{
public:
    explicit Random(std::uint64_t own) : engine_(seed() * 1'000 + own)
    {
        std::printf("[   seed   ] TACTUS_SEED=%llu\n", static_cast<unsigned long long>(seed()));
    }

    [[nodiscard]] static std::uint64_t seed()
    {
        const char* text = std::getenv("TACTUS_SEED");
        return text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
    }
    [[nodiscard]] std::uint64_t bits() { return engine_(); }
    /// 0 .. count - 1.
    [[nodiscard]] std::uint32_t below(std::uint32_t count)
    {
        return static_cast<std::uint32_t>(engine_() % count);
    }
    [[nodiscard]] bool one_in(std::uint32_t count) { return below(count) == 0; }
    [[nodiscard]] double between(double low, double high)
    {
        return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
    }
    [[nodiscard]] Vec3 in_cube(double half)
    {
        return {between(-half, half), between(-half, half), between(-half, half)};
    }

private:
    std::mt19937_64 engine_;
};

[[nodiscard]] inline Vec3f to_float(const Vec3& v)
{
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

} // namespace tactus::test
