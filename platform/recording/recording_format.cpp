// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/recording_format.hpp"

#include "rt_core/kernels/kernels.hpp"

namespace tactus
{

namespace
{

std::string this_compiler()
{
#if defined(__clang__)
    const std::string name = "clang " __clang_version__;
#elif defined(__GNUC__)
    const std::string name = "g++ " __VERSION__;
#else
    const std::string name = "unknown";
#endif
#if defined(__OPTIMIZE__)
    return (name + ", optimised").substr(0, kMaxRecordedNameBytes);
#else
    return (name + ", not optimised").substr(0, kMaxRecordedNameBytes);
#endif
}

std::string this_architecture()
{
#if defined(__x86_64__)
    return "x86-64";
#elif defined(__aarch64__)
    return "aarch64";
#else
    return "unknown";
#endif
}

} // namespace

std::string this_build()
{
    return this_compiler() + ", " + this_architecture();
}

RecordedSetup to_recorded(const FrameSetup& setup)
{
    RecordedSetup recorded;
    recorded.period_ns = setup.period_ns;
    recorded.pose_age_max_ns = setup.pose_age_max_ns;
    recorded.static_when_it_fits = setup.static_when_it_fits;
    recorded.prediction = setup.prediction;
    recorded.force_tolerance_n = setup.force_tolerance_n;
    recorded.tools.assign(setup.tools.begin(), setup.tools.end());
    recorded.objects.assign(setup.objects.begin(), setup.objects.end());
    recorded.poses.assign(setup.poses.begin(), setup.poses.end());
    recorded.poses.resize(setup.objects.size());
    recorded.capacities = capacities_of(setup);
    recorded.for_streamed_models = setup.for_streamed_models;
    for (const ModelSource& model : setup.models)
    {
        recorded.models.push_back({model.capacities,
                                   {model.header.begin(), model.header.end()},
                                   {model.base.begin(), model.base.end()}});
    }
    recorded.compiler = this_compiler();
    recorded.architecture = this_architecture();
    recorded.kernels = setup.kernels != nullptr ? setup.kernels->name : best_kernels().name;
    return recorded;
}

} // namespace tactus
