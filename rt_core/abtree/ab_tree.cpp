// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/abtree/ab_tree.hpp"

#include "rt_core/abtree/ab_tree_refit.hpp"
#include "rt_core/abtree/ab_tree_structure.hpp"

namespace tactus
{

template class BasicAbTree<AabbVolume>;

} // namespace tactus
