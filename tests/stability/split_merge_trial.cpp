// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/split_merge_trial.hpp"

#include "tests/shared/loaded_forest.hpp"
#include "tests/shared/validate_tree.hpp"
#include "tests/stability/rest_state.hpp"

#include <vector>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kWave = 50'000;   ///< Operations between two returns to the base.
constexpr std::uint32_t kRefitEvery = 64; ///< Operations, as many as a frame makes.

/// The boxes, lists and links of the tree against the forest's faces.
std::string faults_of(LoadedForest& sut)
{
    std::vector<ChangedFace> faces;
    for (const PrimId prim : sut.active())
    {
        faces.push_back(sut.forest().describe(prim));
    }
    return tree_faults(sut.tree(), faces);
}

/// One operation, or several where a record needs others; `grows` is the wave's direction.
std::uint32_t change(LoadedForest& sut, bool grows, Random& random)
{
    const RecordId record = sut.random_record(random);
    if (sut.pages().is_refined(record))
    {
        return sut.forest().try_merge(record) ? 1 : 0;
    }
    return grows ? sut.split_with_dependencies(record) : 0;
}

std::uint32_t run_wave(LoadedForest& sut, Random& random)
{
    std::uint32_t operations = 0;
    std::uint32_t refitted = 0;
    // In shrinking phases fewer and fewer records can be merged, so attempts are counted there.
    for (std::uint32_t attempt = 0; operations < kWave; ++attempt)
    {
        const bool grows = (attempt / 4'000) % 3 != 2;
        operations += change(sut, grows, random);
        if (operations - refitted >= kRefitEvery)
        {
            static_cast<void>(sut.tree().refit());
            refitted = operations;
        }
    }
    return operations;
}

} // namespace

TrialFigures run_split_merge_trial(const TestModel& model, std::uint64_t operations,
                                   std::uint64_t seed)
{
    TrialFigures figures;
    figures.name = model.name + ", splits and merges";
    figures.bound = 0.0;
    figures.unit = "returns to another state";
    Random random = Random::seeded(seed);
    LoadedForest sut(model);
    static_cast<void>(sut.tree().refit());
    const RestState start = state_of(sut.forest(), sut.tree());
    while (figures.trials < operations)
    {
        figures.trials += run_wave(sut, random);
        figures.trials += sut.merge_everything(random);
        static_cast<void>(sut.tree().refit());
        const RestState now = state_of(sut.forest(), sut.tree());
        if (const std::string faults = faults_of(sut); !now.is_again(start) || !faults.empty())
        {
            figures.flag(figures.name + ", TACTUS_SEED=" + std::to_string(seed) + ", after " +
                         std::to_string(figures.trials) + ": " + describe(now, start) + faults);
            figures.observe(static_cast<double>(figures.violations));
        }
    }
    return figures;
}

} // namespace tactus::test
