// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/run_results.hpp"
#include "platform/loop/burr.hpp"
#include "platform/loop/cut_tap.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"
#include "transport/edit_request.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vector>

namespace tactus::hrtc
{

class Controller;
struct Options;

/// Request of a cut for the owner of its model. `origin_m` is that of the model's header.
[[nodiscard]] EditRequest request_of(const BurrCut& cut, const BurrShape& shape,
                                     const Vec3& origin_m);

/// Makes edit requests where tools press on models, for a server or an editor of this process. One
/// thread, not the haptic one.
class CutSender
{
public:
    /// Number of edits that a model has got.
    using Edits = std::function<std::uint64_t(std::size_t model)>;
    /// Takes a request; false if it can't.
    using Send = std::function<bool(std::size_t model, EditRequest request)>;

    /// Refused if a tool that is to carve has no volume. Null if no tool is to carve.
    [[nodiscard]] static Result<std::unique_ptr<CutSender>, Refusal>
    create(const Controller& controller, const Options& options);

    /// Tap for the haptic thread, which must not outlive the sender.
    [[nodiscard]] CutTap& tap() noexcept { return tap_; }

    /// Takes the samples, and sends the cuts that are due.
    void step(const Edits& edits, const Send& send);

    [[nodiscard]] CutCounts counts() const
    {
        CutCounts counts = counts_;
        counts.samples_lost = tap_.lost();
        return counts;
    }

private:
    struct Burr
    {
        BurrLaw law;
        std::uint64_t edits{0}; ///< Edits of the model before the last cut.
    };

    CutSender(const Controller& controller, std::map<std::uint32_t, Burr> burrs,
              std::uint32_t cutting);

    std::vector<Vec3> origins_m_;         ///< ModelHeader::origin_m() of each model.
    std::map<std::uint32_t, Burr> burrs_; ///< Burrs by the numbers of their tools.
    CutTap tap_;
    CutCounts counts_;
};

} // namespace tactus::hrtc
