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
#include <ctime>
#include <optional>
#include <sstream>
#include <utility>

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kEncodedBaseFaces = 500;

/// Seconds since it was made or last asked.
class Laps
{
public:
    double next()
    {
        const BenchClock::time_point before = std::exchange(last_, BenchClock::now());
        return seconds(before, last_);
    }

private:
    BenchClock::time_point last_ = BenchClock::now();
};

/// One run, in the child: its times in seconds, then the scene's name.
Result<std::string, SceneError> encode(NamedMesh source, const EncodeJob& job)
{
    const std::clock_t processor_start = std::clock();
    Laps laps;
    PrepareOptions prepare_options;
    prepare_options.position_bits = job.position_bits;
    const auto prepared = prepare_mesh(source.mesh, prepare_options);
    source.mesh = {};
    if (!prepared)
    {
        return SceneError{prepared.error().text};
    }
    const double prepare_s = laps.next();
    SimplifyOptions options;
    options.base_faces = kEncodedBaseFaces;
    options.threads = job.threads;
    const auto simplified = simplify(prepared.value().mesh, options);
    if (!simplified)
    {
        return SceneError{simplified.error().text};
    }
    const double simplify_s = laps.next();
    const auto written = write_spm(job.path, prepared.value(), simplified.value(),
                                   {job.position_bits, kMaxBaseFaces, std::nullopt});
    if (!written)
    {
        return SceneError{written.error().text};
    }
    const double write_s = laps.next();
    const auto processor_s =
        static_cast<double>(std::clock() - processor_start) / static_cast<double>(CLOCKS_PER_SEC);
    return fmt::format("{} {} {} {} {}", prepare_s, simplify_s, write_s, processor_s, source.name);
}

Result<std::string, SceneError> make_and_encode(const EncoderContext& context, const EncodeJob& job)
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
    return encode(std::move(source).value(), job);
}

} // namespace

Result<EncodeRun, SceneError> encode_in_child(const EncoderContext& context, const EncodeJob& job)
{
    EncodeRun best;
    for (std::uint32_t pass = 0; pass < job.passes; ++pass)
    {
        const auto outcome = run_in_child([&] { return make_and_encode(context, job); });
        if (!outcome)
        {
            return outcome.error();
        }
        EncodeRun run;
        std::istringstream(outcome.value().text) >> run.prepare_s >> run.simplify_s >>
            run.write_s >> run.processor_s >> run.scene;
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
