// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/cut_sender.hpp"

#include "platform/choices/run_options.hpp"
#include "platform/controller/controller.hpp"
#include "platform/devices/device_force.hpp"
#include "rt_core/base/assert.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::hrtc
{

EditRequest request_of(const BurrCut& cut, const BurrShape& shape, const Vec3& origin_m)
{
    EditRequest request;
    request.radius_m = shape.radius_m / cut.scale;
    Vec3 middle_m(0.0, 0.0, 0.0);
    if (shape.core_m.size() == 2)
    {
        middle_m = 0.5 * (shape.core_m[0] + shape.core_m[1]);
        request.half_axis_m = to_array((shape.core_m[1] - middle_m) / cut.scale);
    }
    for (const Vec3& vertex_m : shape.core_m)
    {
        if (shape.core_m.size() > 2)
        {
            request.hull_m.push_back(to_array(vertex_m / cut.scale));
        }
    }
    const Eigen::Quaterniond rotation(cut.rotation);
    const auto place_of = [&](const Vec3& place_m)
    {
        const Vec3 shown_m = origin_m + place_m + cut.rotation * (middle_m / cut.scale);
        return Pose{{rotation.x(), rotation.y(), rotation.z(), rotation.w()}, to_array(shown_m)};
    };
    request.from = place_of(cut.from_m);
    request.to = place_of(cut.to_m);
    return request;
}

Result<std::unique_ptr<CutSender>, Refusal> CutSender::create(const Controller& controller,
                                                              const Options& options)
{
    std::map<std::uint32_t, Burr> burrs;
    std::uint32_t cutting = 0;
    for (std::uint32_t tool = 0; tool < options.tools.size(); ++tool)
    {
        const double rate_m3_per_s = options.tools[tool].carve_rate_m3_per_s;
        if (rate_m3_per_s == 0.0)
        {
            continue;
        }
        const ToolSpec& spec = controller.tools()[tool].spec;
        auto shape = burr_shape(spec.core, spec.radius_m);
        if (!shape)
        {
            return Refusal{
                fmt::format("{}: the tool has no volume", options.of_tool("--edit", tool))};
        }
        burrs.emplace(tool, Burr{BurrLaw(std::move(*shape), rate_m3_per_s)});
        cutting |= 1U << tool;
    }
    return cutting == 0
               ? nullptr
               : std::unique_ptr<CutSender>(new CutSender(controller, std::move(burrs), cutting));
}

CutSender::CutSender(const Controller& controller, std::map<std::uint32_t, Burr> burrs,
                     std::uint32_t cutting)
    : burrs_(std::move(burrs)), tap_(cutting)
{
    for (const ServedModel& model : controller.models())
    {
        origins_m_.push_back(ModelHeader::parse(model.header).value().origin_m());
    }
}

void CutSender::step(const Edits& edits, const Send& send)
{
    for (CutSample sample; tap_.try_take(sample);)
    {
        Burr& burr = burrs_.at(sample.tool);
        const std::uint64_t count = edits(sample.model.value);
        if (count != burr.edits)
        {
            burr.law.note_answer();
        }
        if (const auto cut = burr.law.add(sample))
        {
            burr.edits = count;
            const std::size_t model = cut->model.value;
            const bool is_sent = send(model, request_of(*cut, burr.law.shape(), origins_m_[model]));
            ++(is_sent ? counts_.sent : counts_.unsent);
            counts_.volume_m3 += is_sent ? cut->volume_m3 : 0.0;
        }
    }
}

} // namespace tactus::hrtc
