// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/encode_run.hpp"

#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "tests/bench/child_process.hpp"
#include "tests/bench/measuring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kBaseFaces = 500;

/// One run, in the child: its times in seconds, then the scene's name.
Result<std::string, SceneError> encode(const EncoderContext& context, const EncodeJob& job)
{
    std::optional<PinnedCore> pinned;
    if (job.threads == 1)
    {
        pinned.emplace(context.options.core);
    }
    auto source = context.mesh.make();
    if (!source)
    {
        return source.error();
    }
    const BenchClock::time_point start = BenchClock::now();
    PrepareOptions prepare_options;
    prepare_options.position_bits = job.position_bits;
    const auto prepared = prepare_mesh(source.value().mesh, prepare_options);
    source.value().mesh = {};
    if (!prepared)
    {
        return SceneError{prepared.error().text};
    }
    const BenchClock::time_point ready = BenchClock::now();
    SimplifyOptions options;
    options.base_faces = kBaseFaces;
    options.threads = job.threads;
    const auto simplified = simplify(prepared.value().mesh, options);
    if (!simplified)
    {
        return SceneError{simplified.error().text};
    }
    const BenchClock::time_point simple = BenchClock::now();
    const auto written = write_spm(job.path, prepared.value(), simplified.value(),
                                   {job.position_bits, kMaxBaseFaces, std::nullopt});
    if (!written)
    {
        return SceneError{written.error().text};
    }
    const BenchClock::time_point end = BenchClock::now();
    return fmt::format("{} {} {} {}", seconds(start, ready), seconds(ready, simple),
                       seconds(simple, end), source.value().name);
}

} // namespace

Result<EncodeRun, SceneError> encode_in_child(const EncoderContext& context, const EncodeJob& job)
{
    EncodeRun best;
    for (std::uint32_t pass = 0; pass < job.passes; ++pass)
    {
        const auto outcome = run_in_child([&] { return encode(context, job); });
        if (!outcome)
        {
            return outcome.error();
        }
        EncodeRun run;
        std::istringstream(outcome.value().text) >> run.prepare_s >> run.simplify_s >>
            run.write_s >> run.scene;
        const std::uint64_t peak_bytes = std::max(outcome.value().peak_bytes, best.peak_bytes);
        if (pass == 0 || run.total_s() < best.total_s())
        {
            best = run;
        }
        best.peak_bytes = peak_bytes;
    }
    return best;
}

} // namespace tactus::bench
