// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/namesakes.hpp"

#include <fmt/format.h>

namespace tactus
{

namespace
{

constexpr std::chrono::milliseconds kLookEvery{100};
/// Maximum number of logged offers, so that many unknown servers do not fill the log.
constexpr std::size_t kMaxTold = 64;

} // namespace

Result<Namesakes, Refusal> Namesakes::create(const dds::DdsServer& server, std::string scene,
                                             Log log)
{
    auto catalogue = dds::Catalogue::create(server.domain(), log);
    if (!catalogue)
    {
        return catalogue.error();
    }
    return Namesakes(server, std::move(scene), std::move(catalogue).value(), std::move(log));
}

Namesakes::Namesakes(const dds::DdsServer& server, std::string scene, dds::Catalogue catalogue,
                     Log log)
    : server_(server)
    , scene_(std::move(scene))
    , catalogue_(std::move(catalogue))
    , log_(std::move(log))
{
    for (const dds::ModelPieces& model : server.models())
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
    for (const dds::ModelPieces& model : server_.models())
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
    const bool is_ours = other.server_epoch == server_.epoch();
    if (!is_ours && told_.size() < kMaxTold && told_.emplace(other.server_epoch, what).second)
    {
        log_.write(fmt::format("warning: {} by {} as well; a controller follows the server that "
                               "answers first; choose a server with {}@SERVER",
                               what, catalogue_.participants().name_of(other.server), name));
    }
}

} // namespace tactus
