// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/shapes.hpp"
#include "rt_core/math/triangle.hpp"
#include "tests/shared/random.hpp"

#include <array>
#include <ostream>

namespace tactus::test
{

/// Two triangles. For a segment the first loses a corner; for a box its corners give the extents.
struct TrianglePair
{
    Triangle first;
    Triangle second;

    [[nodiscard]] Segment segment() const { return {first[0], first[1]}; }
};

/// A kind of pairs that a kernel must get right.
struct PairClass
{
    const char* name;
    TrianglePair (*make)(Random&);
};

inline void PrintTo(const PairClass& kind, std::ostream* out)
{
    *out << kind.name;
}

inline constexpr std::size_t kPairClasses = 15;
[[nodiscard]] const std::array<PairClass, kPairClasses>& pair_classes();

/// A box and a triangle made from a pair of them: somewhere, or near a place on the box's surface.
struct BoxScene
{
    Box box;
    Triangle triangle;
};
[[nodiscard]] BoxScene box_scene(const TrianglePair& pair, Random& random);

/// How often each property is tried on each class: few in every test command, and as many as
/// TACTUS_KERNEL_CASES says.
[[nodiscard]] int cases_per_class();

} // namespace tactus::test
