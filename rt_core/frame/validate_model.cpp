// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/validate_model.hpp"

#include "rt_core/abtree/validate_tree.hpp"
#include "rt_core/cache/validate_cache.hpp"
#include "rt_core/forest/validate_forest.hpp"
#include "rt_core/spm/validate_pages.hpp"

namespace tactus
{

Flaw find_flaw(const Model& model) noexcept
{
    Flaw flaw = find_flaw(model.pages, model.header.counts());
    flaw = flaw.is_none() ? find_flaw(model.cache) : flaw;
    flaw = flaw.is_none() ? find_flaw(model.tree) : flaw;
    return flaw.is_none() ? find_flaw(model.forest) : flaw;
}

void require_sound(const Model& model) noexcept
{
    if (const Flaw flaw = find_flaw(model); !flaw.is_none())
    {
        assertion_failed(text_of(flaw).data(), __FILE__, __LINE__);
    }
}

} // namespace tactus
