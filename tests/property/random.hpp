// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

namespace tactus::test
{

/// The seed of a property test: fixed, or TACTUS_SEED to repeat or vary a run.
[[nodiscard]] inline std::uint64_t seed_of(std::uint64_t usual)
{
    const char* text = std::getenv("TACTUS_SEED");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : usual;
}

class Random
{
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    [[nodiscard]] double between(double low, double high)
    {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    [[nodiscard]] std::size_t below(std::size_t count)
    {
        return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_);
    }
    [[nodiscard]] Vec3 in_cube(double half)
    {
        return {between(-half, half), between(-half, half), between(-half, half)};
    }

private:
    std::mt19937_64 engine_;
};

} // namespace tactus::test
