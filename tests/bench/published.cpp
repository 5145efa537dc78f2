// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/published.hpp"

#include <fmt/format.h>

#include <unistd.h>

namespace tactus::bench
{

std::uint32_t dds_domain()
{
    constexpr std::uint32_t kDomains = 231;
    return static_cast<std::uint32_t>(::getpid()) % kDomains;
}

Program start_at(const NetworkEnd& end, const std::string& name,
                 const std::filesystem::path& folder, const std::vector<std::string>& arguments)
{
    ProgramSetup setup;
    setup.words = {program_path(name), "--domain", fmt::format("{}", dds_domain())};
    setup.words.insert(setup.words.end(), arguments.begin(), arguments.end());
    if (!end.dds_uri.empty())
    {
        setup.words.emplace_back("--plain");
    }
    setup.network = end.network;
    setup.dds_uri = end.dds_uri;
    setup.output = folder / (name + ".log");
    return Program::start(setup);
}

Program publish(const Scene& scene, const NetworkEnd& end, const std::filesystem::path& folder)
{
    Program server = start_at(end, "spm_publish", folder, {scene.model.path, "--name", "model"});
    server.wait_for("ready on DDS domain", kStartTimeout);
    return server;
}

} // namespace tactus::bench
