// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/property/visited_nodes.hpp"

namespace tactus::test
{
namespace
{

TEST(VisitedNodesLarge, over_4_m_faces_keep_the_papers_bound)
{
    expect_lemma(make_face_grid(1'448, 1'448), 3);
}

} // namespace
} // namespace tactus::test
