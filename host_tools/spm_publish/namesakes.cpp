// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/namesakes.hpp"

#include <fmt/format.h>

namespace tactus
{

namespace
{

constexpr std::chrono::milliseconds kLookEvery{100};
/// Maximum number of log lines, so that many unknown servers do not fill the log.
constexpr std::size_t kMaxTold = 64;

} // namespace

Result<Namesakes, Refusal> Namesakes::create(const dds::DdsHost& host, std::string scene, Log log)
{
    auto catalogue = dds::Catalogue::create(host.domain(), log);
    if (!catalogue)
    {
        return catalogue.error();
    }
    return Namesakes(host, std::move(scene), std::move(catalogue).value(), std::move(log));
}

Namesakes::Namesakes(const dds::DdsHost& host, std::string scene, dds::Catalogue catalogue, Log log)
    : host_(host), scene_(std::move(scene)), catalogue_(std::move(catalogue)), log_(std::move(log))
{
    for (const dds::ModelPieces& model : host.models())
    {
        catalogue_.ask_for({model.model().name});
    }
    if (!scene_.empty())
    {
        catalogue_.ask_for_scene(scene_);
    }
}

void Namesakes::update()
{
    const auto now = Clock::now();
    if (now - looked_ < kLookEvery)
    {
        return;
    }
    looked_ = now;
    catalogue_.refresh();
    if (std::exchange(seen_, catalogue_.version()) == catalogue_.version())
    {
        return;
    }
    for (const dds::ModelPieces& model : host_.models())
    {
        const std::string& name = model.model().name;
        for (const dds::Catalogue::Offer* other : catalogue_.servers_of({name}))
        {
            look_at(*other, name,
                    fmt::format("model '{}' is offered{}", name,
                                other->hash == model.store().hash() ? "" : ", with another hash,"));
        }
    }
    if (!scene_.empty())
    {
        for (const dds::Catalogue::Offer* other : catalogue_.servers_of_scene({scene_}))
        {
            look_at(*other, scene_, fmt::format("scene '{}' is offered", scene_));
        }
    }
}

void Namesakes::look_at(const dds::Catalogue::Offer& other, const std::string& name,
                        const std::string& what)
{
    const bool is_ours = other.host_epoch == host_.epoch();
    if (!is_ours && told_.size() < kMaxTold && told_.emplace(other.host_epoch, what).second)
    {
        log_.write(fmt::format("warning: {} by {} as well; a controller follows the one that "
                               "answers first, {}@SERVER chooses",
                               what, catalogue_.participants().name_of(other.host), name));
    }
}

} // namespace tactus
