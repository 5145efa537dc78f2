// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/dop18_tree.hpp"

#include "rt_core/abtree/ab_tree_refit.hpp"
#include "rt_core/abtree/ab_tree_structure.hpp"

namespace tactus
{

template class BasicAbTree<test::Dop18Volume>;

} // namespace tactus
