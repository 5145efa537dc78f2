// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <concepts>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <type_traits>

namespace tactus::test
{

/// Seed of a run that is repeated by its seed alone: fixed, or TACTUS_SEED to repeat or vary it.
[[nodiscard]] inline std::uint64_t seed_of(std::uint64_t usual)
{
    const char* text = std::getenv("TACTUS_SEED");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : usual;
}

/// Random numbers of tests, the same on every machine.
class Random
{
public:
    /// Numbers of one test: `own` separates it from the others under the same TACTUS_SEED, which is
    /// printed.
    explicit Random(std::uint64_t own) : engine_(seed() * 1'000 + own)
    {
        std::printf("[   seed   ] TACTUS_SEED=%llu\n", static_cast<unsigned long long>(seed()));
    }
    /// Numbers of this seed alone; the caller prints it.
    [[nodiscard]] static Random seeded(std::uint64_t seed) { return Random(std::mt19937_64(seed)); }

    /// TACTUS_SEED, or 1.
    [[nodiscard]] static std::uint64_t seed() { return seed_of(1); }
    [[nodiscard]] std::uint64_t bits() { return engine_(); }
    /// Number in 0 .. count - 1.
    template <std::integral Count>
    [[nodiscard]] auto below(Count count)
    {
        using Index =
            std::conditional_t<sizeof(Count) <= sizeof(std::uint32_t), std::uint32_t, std::size_t>;
        return static_cast<Index>(engine_() % static_cast<std::uint64_t>(count));
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
    explicit Random(const std::mt19937_64& engine) : engine_(engine) {}

    std::mt19937_64 engine_;
};

/// Well-mixed 64-bit number for each index, in any order.
[[nodiscard]] constexpr std::uint64_t mixed(std::uint64_t seed, std::uint64_t index)
{
    std::uint64_t bits = (seed + 1) * 0x9E37'79B9'7F4A'7C15ULL + index * 0xD1B5'4A32'D192'ED03ULL;
    bits = (bits ^ (bits >> 32U)) * 0xBF58'476D'1CE4'E5B9ULL;
    bits = (bits ^ (bits >> 29U)) * 0x94D0'49BB'1331'11EBULL;
    return bits ^ (bits >> 32U);
}

/// Uniform number in -1 .. 1 for each index.
[[nodiscard]] constexpr double signed_unit(std::uint64_t seed, std::uint64_t index)
{
    return static_cast<double>(mixed(seed, index) >> 11U) * 0x1p-52 - 1.0;
}

} // namespace tactus::test
