// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Smallest pools in which a scene of large models starts.

#include "tests/bench/scene_cases.hpp"
#include "tests/shared/frame_rig.hpp"
#include "transport/pool_plan.hpp"

#include <fmt/format.h>

#include <vector>

namespace tactus::bench
{

namespace
{

constexpr SceneSource kLarge{"bumpy-200k", nullptr, 0, 200'000};

struct PoolCase
{
    std::uint32_t models;
    std::uint32_t tools;
    double goal_mib;
};

/// Memory by `--pool-mib` if each model is shown by one object; checks that a frame runs in it.
void run_pool_case(const CaseContext& context, const PoolCase& test_case)
{
    const Scene& scene = context.scenes.get(kLarge);
    const test::TestModel& model = scene.model;
    const auto served = needed(serve_from_file(model.path, model.name, {}));
    test::RigOptions options;
    options.tools.assign(test_case.tools, ToolSpec{0.01 * model.diagonal_m});
    for (std::uint32_t i = 0; i < test_case.models; ++i)
    {
        options.objects.push_back({ModelId{i}});
    }
    options.poses.resize(test_case.models);
    FrameSetup setup;
    setup.tools = options.tools;
    setup.objects = options.objects;
    setup.poses = options.poses;
    const std::vector<ModelHeader> headers(test_case.models,
                                           ModelHeader::parse(served.header).value());
    options.pool_bytes = least_pool_bytes(setup, headers, 0);
    test::FrameRig rig(std::vector(test_case.models, &model), options);
    const FrameOutput output =
        rig.step(std::vector<Vec3>(test_case.tools, to_vec3(model.faces[0][0])), {});
    if (output.pairs.size() != std::size_t{test_case.models} * test_case.tools)
    {
        throw Failure(fmt::format("{} pairs are answered of {} models and {} tools",
                                  output.pairs.size(), test_case.models, test_case.tools));
    }
    Row common = context.common_row(model.name);
    common.test_case = fmt::format("{} models of 200,000 faces", test_case.models);
    common.setting = fmt::format("{} tools", test_case.tools);
    CaseRows rows(context.rows, common);
    rows.add("least pool", static_cast<double>(options.pool_bytes + sizeof(Frame)) / 0x1p20, "MiB",
             goal_if(test_case.goal_mib));
}

} // namespace

std::vector<Case> scene_memory_cases()
{
    std::vector<Case> cases;
    for (const PoolCase& test_case : {PoolCase{1, 1, kNoGoal}, PoolCase{8, 4, 2.0}})
    {
        cases.push_back(
            make_case(fmt::format("pool of {} models, {} tools", test_case.models, test_case.tools),
                      When::always, run_pool_case, test_case));
    }
    return cases;
}

} // namespace tactus::bench
