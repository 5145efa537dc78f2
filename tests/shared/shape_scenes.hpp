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

/// Two triangles. A segment is the first without one corner; a box takes its extents from the
/// corners.
struct TrianglePair
{
    Triangle first;
    Triangle second;

    [[nodiscard]] Segment segment() const { return {first[0], first[1]}; }
};

/// Class of pairs that a kernel must handle.
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

/// Box and triangle made from a pair: anywhere, or near a place on the box's surface.
struct BoxScene
{
    Box box;
    Triangle triangle;
};
[[nodiscard]] BoxScene box_scene(const TrianglePair& pair, Random& random);

/// Cases of each property and class: few by default, or TACTUS_KERNEL_CASES.
[[nodiscard]] int cases_per_class();

} // namespace tactus::test
