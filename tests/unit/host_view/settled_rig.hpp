// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/model_shelf.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/test_model.hpp"
#include "transport/refinement_state.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

/// Frame at work and its data for a viewer.
namespace tactus::view::test
{

/// Resident pages of a model, by chunk.
inline std::vector<RefinementStatePage> pages_of(const Model& model)
{
    std::vector<RefinementStatePage> pages;
    for (std::uint32_t slot = 0; slot < model.pages.capacity(); ++slot)
    {
        if (model.pages.is_own(slot))
        {
            pages.push_back({model.pages.meta(slot).chunk, model.pages.meta(slot).refined});
        }
    }
    std::ranges::sort(pages, {}, &RefinementStatePage::chunk);
    return pages;
}

/// Rig with a tool that touches a corner of the first small model, fully loaded.
inline std::unique_ptr<tactus::test::FrameRig> settled_rig()
{
    const tactus::test::TestModel& model = tactus::test::small_model(0);
    tactus::test::RigOptions options = tactus::test::with_room_for_all();
    options.static_when_it_fits = false;
    options.tools = {{0.01 * model.diagonal_m, 500.0}};
    auto rig = std::make_unique<tactus::test::FrameRig>(model, options);
    rig->settle(to_vec3(model.faces.front()[0]), {}, 2'000);
    return rig;
}

/// Model of a viewer, from its file.
struct Shelved
{
    explicit Shelved(const tactus::test::TestModel& model = tactus::test::small_model(0))
    {
        const std::vector<std::string> files{model.path.string()};
        shelf = std::move(ModelShelf::open(files)).value();
        known = shelf->find(shelf->labels().front().hash);
    }
    std::unique_ptr<ModelShelf> shelf;
    std::shared_ptr<KnownModel> known;
};

} // namespace tactus::view::test
