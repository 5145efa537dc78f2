// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>

namespace tactus
{

/// Sorts a short list by `before`, a strict total order, without the recursion of std::sort.
template <typename List, typename Before>
void sort_without_recursion(List& list, const Before& before) noexcept
{
    std::make_heap(list.begin(), list.end(), before);
    std::sort_heap(list.begin(), list.end(), before);
}

} // namespace tactus
