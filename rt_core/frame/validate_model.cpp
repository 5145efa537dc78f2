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
    if (model.stage == ModelStage::known)
    {
        FlawFinder finder;
        finder.expect(model.forest.active_faces() == 0, "known model", model.pages.owner(),
                      "has faces");
        finder.expect(model.tree.blocks_used() + model.tree.nodes_used() == 0, "known model",
                      model.pages.owner(), "has a tree");
        finder.expect(model.pages.used() + model.cache.index_pages_used() == 0, "known model",
                      model.pages.owner(), "has pages");
        flaw = flaw.is_none() ? finder.first() : flaw;
    }
    // A forest is only checked if resident: before and after, the model is not whole.
    return flaw.is_none() && model.is_resident() ? find_flaw(model.forest) : flaw;
}

void require_sound(const Model& model) noexcept
{
    if (const Flaw flaw = find_flaw(model); !flaw.is_none())
    {
        assertion_failed(text_of(flaw).data(), __FILE__, __LINE__);
    }
}

} // namespace tactus
