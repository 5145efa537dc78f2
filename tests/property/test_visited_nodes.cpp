// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/property/visited_nodes.hpp"

namespace tactus::test
{
namespace
{

struct GridSize
{
    std::uint32_t columns;
    std::uint32_t rows;
};

/// Grids with two faces a square. The blocks of a grid with sides of powers of two are full; those
/// of the others hold 9 to 10.6 faces, as on scanned meshes. Some counts are just above a power of
/// two, where a left-full order is least even.
std::vector<GridSize> grid_sizes()
{
    return {{45, 45},   {50, 41},   {64, 32},   {64, 64},   {65, 64},   {90, 91},   {110, 110},
            {129, 128}, {150, 151}, {181, 181}, {256, 256}, {300, 300}, {513, 256}, {724, 724}};
}

class VisitedNodes : public testing::TestWithParam<std::size_t>
{
protected:
    const FaceGrid grid_ =
        make_face_grid(grid_sizes()[GetParam()].columns, grid_sizes()[GetParam()].rows);
};

TEST_P(VisitedNodes, keep_the_papers_bound)
{
    expect_lemma(grid_, 5);
}

INSTANTIATE_TEST_SUITE_P(grids, VisitedNodes, testing::Range<std::size_t>(0, 14));

} // namespace
} // namespace tactus::test
