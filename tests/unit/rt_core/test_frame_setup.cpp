// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/frame_setup.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <optional>

namespace tactus::test
{

namespace
{

/// Refusal for these numbers, all of model 0, whose header is empty.
std::optional<FrameRefusal> refusal_of(std::size_t tools, std::size_t objects, std::size_t models,
                                       const SceneCapacities& capacities = {})
{
    static const std::array<ToolSpec, kMaxTools + 1> kTools{};
    std::array<ObjectSpec, kMaxObjects + 1> shown;
    shown.fill(ObjectSpec{ModelId{0}});
    static const std::array<ModelSource, kMaxModels + 1> kModels{};
    FrameSetup setup;
    setup.tools = std::span(kTools).first(tools);
    setup.objects = std::span(shown).first(objects);
    setup.models = std::span(kModels).first(models);
    setup.capacities = capacities;
    return find_refusal(setup);
}

} // namespace

TEST(FrameSetup, takes_as_many_tools_objects_and_models_as_the_limits_and_refuses_none_or_more)
{
    const FrameRefusal counts_are_fine =
        FrameRefusal::header_refused; // The header is checked later.
    EXPECT_EQ(refusal_of(1, 1, 1), counts_are_fine);
    EXPECT_EQ(refusal_of(kMaxTools, kMaxObjects, kMaxModels), counts_are_fine);
    EXPECT_EQ(refusal_of(kMaxTools + 1, 1, 1), FrameRefusal::too_many);
    EXPECT_EQ(refusal_of(1, kMaxObjects + 1, 1), FrameRefusal::too_many);
    EXPECT_EQ(refusal_of(1, 1, kMaxModels + 1), FrameRefusal::too_many);
    EXPECT_EQ(refusal_of(0, 1, 1), FrameRefusal::too_many);
    EXPECT_EQ(refusal_of(1, 0, 1), counts_are_fine); // They may be added later.
    EXPECT_EQ(refusal_of(1, 1, 0), FrameRefusal::too_many);
    EXPECT_EQ(refusal_of(1, 2, 1, {2, kMaxPairs}), counts_are_fine);
    EXPECT_EQ(refusal_of(1, 2, 1, {kMaxObjects, 1}), counts_are_fine);
    EXPECT_EQ(refusal_of(1, 2, 1, {1, 0}), FrameRefusal::too_many);
    EXPECT_EQ(refusal_of(1, 1, 1, {kMaxObjects + 1, 0}), FrameRefusal::too_many);
    EXPECT_EQ(refusal_of(1, 1, 1, {1, kMaxPairs + 1}), FrameRefusal::too_many);
}

TEST(FrameSetup, takes_as_many_faces_of_all_models_as_the_limit)
{
    std::array<ModelSource, 2> models;
    const std::array<ObjectSpec, 1> objects{ObjectSpec{ModelId{0}}};
    const std::array<ToolSpec, 1> tools{};
    FrameSetup setup;
    setup.models = models;
    setup.objects = objects;
    setup.tools = tools;
    models[1].capacities.faces = kMaxPoolFaces;
    EXPECT_EQ(find_refusal(setup), FrameRefusal::header_refused); // The header is checked later.
    models[0].capacities.faces = 1;
    EXPECT_EQ(find_refusal(setup), FrameRefusal::too_many_faces);
}

TEST(FrameSetup, takes_a_force_tolerance_up_to_the_limit)
{
    const std::array<ModelSource, 1> models{};
    const std::array<ToolSpec, 1> tools{};
    FrameSetup setup;
    setup.models = models;
    setup.tools = tools;
    for (const double taken : {0.0, kForceToleranceUsual_n, kForceToleranceMax_n})
    {
        setup.force_tolerance_n = taken;
        // The header is checked later.
        EXPECT_EQ(find_refusal(setup), FrameRefusal::header_refused) << taken;
    }
    for (const double refused :
         {-1e-9, 1.01 * kForceToleranceMax_n, std::numeric_limits<double>::quiet_NaN(),
          std::numeric_limits<double>::infinity()})
    {
        setup.force_tolerance_n = refused;
        EXPECT_EQ(find_refusal(setup), FrameRefusal::bad_tolerance) << refused;
    }
}

TEST(FrameSetup, refuses_models_that_are_not_there_and_a_tool_s_model_that_an_object_shows)
{
    const std::array<ModelSource, 2> models{};
    std::array<ObjectSpec, 1> objects{ObjectSpec{ModelId{0}}};
    std::array<ToolSpec, 1> tools{};
    FrameSetup setup;
    setup.models = models;
    setup.objects = objects;
    setup.tools = tools;
    tools[0].core = MeshCore{ModelId{0}, Vec3(0, 0, 0), Vec3(0, 0, 0)};
    EXPECT_EQ(find_refusal(setup), FrameRefusal::shared_model);
    tools[0].core = MeshCore{ModelId{2}, Vec3(0, 0, 0), Vec3(0, 0, 0)};
    EXPECT_EQ(find_refusal(setup), FrameRefusal::unknown_model);
    tools[0].core = MeshCore{ModelId{1}, Vec3(0, 0, 0), Vec3(0, 0, 0)};
    EXPECT_EQ(find_refusal(setup), FrameRefusal::header_refused);
    objects[0].model = ModelId{2};
    EXPECT_EQ(find_refusal(setup), FrameRefusal::unknown_model);
}

} // namespace tactus::test
