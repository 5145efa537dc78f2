// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/property/visited_nodes.hpp"

namespace tactus::test
{
namespace
{

using GridSize = std::pair<std::uint32_t, std::uint32_t>;

/// Grids with two faces a square. The blocks of a grid with sides of powers of two are full; those
/// of the others hold 9 to 10.6 faces, as on scanned meshes. Some counts are just above a power of
/// two, where a left-full order is least even.
constexpr GridSize kGridSizes[] = {{45, 45},   {50, 41},   {64, 32},   {64, 64},   {65, 64},
                                   {90, 91},   {110, 110}, {129, 128}, {150, 151}, {181, 181},
                                   {256, 256}, {300, 300}, {513, 256}, {724, 724}};

class VisitedNodes : public testing::TestWithParam<GridSize>
{
};

TEST_P(VisitedNodes, keep_the_papers_bound)
{
    expect_lemma(make_face_grid(GetParam().first, GetParam().second), 5);
}

INSTANTIATE_TEST_SUITE_P(grids, VisitedNodes, testing::ValuesIn(kGridSizes));

} // namespace
} // namespace tactus::test
