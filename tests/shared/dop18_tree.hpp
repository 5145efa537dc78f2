// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "tests/shared/dop18_volume.hpp"

namespace tactus
{

extern template class BasicAbTree<test::Dop18Volume>;

namespace test
{

/// AB-Tree over 18-DOPs, for tests and benches. 640 B a node.
using Dop18Tree = BasicAbTree<Dop18Volume>;

static_assert(sizeof(Dop18Tree::Node) == 640);

} // namespace test
} // namespace tactus
