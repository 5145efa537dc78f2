// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/property/visited_nodes.hpp"

namespace tactus::test
{
namespace
{

TEST(VisitedNodesLarge, of_both_trees_over_4_m_faces_keep_the_papers_bound)
{
    const FaceGrid grid = make_face_grid(1'448, 1'448);
    expect_lemma_of_8_wide(grid, 4'096, 3);
    expect_lemma_of_binary(grid, 4'096, 3);
}

} // namespace
} // namespace tactus::test
