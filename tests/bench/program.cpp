// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/bench/program.hpp"

#include "tests/bench/bench_row.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <fstream>
#include <malloc.h>
#include <sched.h>
#include <string_view>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace tactus::bench
{
namespace
{

using Json = nlohmann::json;

NetworkEnd end_of(const Json& ready, const char* name)
{
    return {fmt::format("/proc/{}/fd/{}", ready["pid"].get<int>(), ready[name]["fd"].get<int>()),
            ready[name]["dds"].get<std::string>()};
}

} // namespace

RelayedNetworks RelayedNetworks::make(const LinkManner& manner, const std::filesystem::path& folder)
{
    ProgramSetup setup;
    setup.words = {program_path("network_relay"),
                   "--delay-ms",
                   fmt::format("{}", manner.delay_ms),
                   "--loss",
                   fmt::format("{}", manner.loss),
                   "--seed",
                   fmt::format("{}", kSeed)};
    setup.output = folder / "relay.log";
    setup.is_asked = true;
    auto relay = Program::start(setup);
    RelayedNetworks networks(std::move(relay));
    const auto ready = networks.relay_.ask("");
    const Json facts = Json::parse(ready);
    networks.server_ = end_of(facts, "server");
    networks.controller_ = end_of(facts, "controller");
    return networks;
}

LinkTraffic RelayedNetworks::traffic()
{
    const auto answer = relay_.ask("count");
    const Json counted = Json::parse(answer);
    LinkTraffic traffic;
    for (const char* direction : {"to_server", "to_controller"})
    {
        traffic.payload_bytes += counted[direction]["udp_payload_bytes"].get<std::uint64_t>();
        traffic.datagrams += counted[direction]["udp_datagrams"].get<std::uint64_t>();
    }
    return traffic;
}

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

namespace
{

constexpr int kWorkDone = 0;
constexpr int kWorkFailed = 1;

void write_all(int file, std::string_view text)
{
    while (!text.empty())
    {
        const ssize_t written = ::write(file, text.data(), text.size());
        if (written < 0 && errno != EINTR)
        {
            ::_exit(kWorkFailed);
        }
        text.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
    }
}

std::string read_all(int file)
{
    std::string text;
    std::array<char, 4'096> buffer{};
    ssize_t count = 0;
    do
    {
        count = ::read(file, buffer.data(), buffer.size());
        text.append(buffer.data(), count < 0 ? 0 : static_cast<std::size_t>(count));
    } while (count > 0 || (count < 0 && errno == EINTR));
    return text;
}

/// Body of the child. It exits without the parent's destructors and buffers.
[[noreturn]] void live(int answer, const std::function<std::string()>& work)
{
    int code = kWorkFailed;
    std::string text;
    try
    {
        text = work();
        code = kWorkDone;
    }
    catch (const std::exception& error)
    {
        text = error.what();
    }
    write_all(answer, text);
    ::_exit(code);
}

} // namespace

ChildOutcome run_in_child(const std::function<std::string()>& work)
{
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0)
    {
        throw Failure(fmt::format("no pipe to a child process: {}", std::strerror(errno)));
    }
    ::malloc_trim(0); // The child inherits memory that was freed but not returned.
    const pid_t child = ::fork();
    if (child == 0)
    {
        ::close(ends[0]);
        live(ends[1], work);
    }
    const int fork_error = errno;
    ::close(ends[1]);
    const std::string text = child < 0 ? "" : read_all(ends[0]);
    ::close(ends[0]);
    if (child < 0)
    {
        throw Failure(fmt::format("no child process: {}", std::strerror(fork_error)));
    }
    int status = 0;
    rusage usage{};
    while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR)
    {
    }
    if (WIFSIGNALED(status))
    {
        throw Failure(fmt::format("a child process was ended by signal {}", WTERMSIG(status)));
    }
    if (WEXITSTATUS(status) != kWorkDone)
    {
        throw Failure(text);
    }
    return ChildOutcome{text, static_cast<std::uint64_t>(usage.ru_maxrss) * 1'024};
}

namespace
{

constexpr int kNotStarted = 127;

/// Replaces the child by the other program. Returns only on failure.
void become(const ProgramSetup& setup, int talk)
{
    const int output = ::open(setup.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (output < 0 || ::dup2(output, STDERR_FILENO) < 0 ||
        ::dup2(setup.is_asked ? talk : output, STDOUT_FILENO) < 0 ||
        (setup.is_asked && ::dup2(talk, STDIN_FILENO) < 0))
    {
        return;
    }
    cpu_set_t all;
    std::memset(&all, 0xFF, sizeof(all));
    static_cast<void>(::sched_setaffinity(0, sizeof(all), &all));
    if (!setup.network.empty())
    {
        const int network = ::open(setup.network.c_str(), O_RDONLY | O_CLOEXEC);
        if (network < 0 || ::setns(network, CLONE_NEWNET) != 0)
        {
            return;
        }
    }
    if (setup.dds_uri.empty())
    {
        ::unsetenv("CYCLONEDDS_URI");
    }
    else
    {
        ::setenv("CYCLONEDDS_URI", setup.dds_uri.c_str(), 1);
    }
    std::vector<char*> words;
    for (const std::string& word : setup.words)
    {
        words.push_back(const_cast<char*>(word.c_str()));
    }
    words.push_back(nullptr);
    ::execv(words[0], words.data());
}

std::string last_line(const std::string& text)
{
    const std::size_t end = text.find_last_not_of('\n');
    const std::size_t begin = text.find_last_of('\n', end);
    return end == std::string::npos ? std::string("nothing") : text.substr(begin + 1, end - begin);
}

} // namespace

std::filesystem::path program_path(const std::string& name)
{
    const auto own = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    const auto beside = own / name;
    return std::filesystem::exists(beside) ? beside : own.parent_path() / "tests" / name;
}

nlohmann::json report_in(const std::filesystem::path& output)
{
    std::ifstream file(output);
    std::string line;
    while (std::getline(file, line) && !line.starts_with('{'))
    {
    }
    return nlohmann::json::parse(line);
}

Program Program::start(const ProgramSetup& setup)
{
    Program program;
    program.name_ = std::filesystem::path(setup.words[0]).filename();
    program.output_ = setup.output;
    std::array<int, 2> ends{-1, -1};
    if (setup.is_asked && ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    {
        throw Failure(fmt::format("{}: no socket: {}", program.name_, std::strerror(errno)));
    }
    const pid_t child = ::fork();
    if (child == 0)
    {
        become(setup, ends[1]);
        ::_exit(kNotStarted);
    }
    const int fork_error = errno;
    if (ends[1] >= 0)
    {
        ::close(ends[1]);
    }
    program.talk_ = ends[0];
    if (child < 0)
    {
        throw Failure(fmt::format("{}: no process: {}", program.name_, std::strerror(fork_error)));
    }
    program.id_ = child;
    return program;
}

Program::~Program()
{
    if (id_ != 0)
    {
        ::kill(id_, SIGKILL);
        ::waitpid(id_, nullptr, 0);
    }
    if (talk_ >= 0)
    {
        ::close(talk_);
    }
}

void Program::wait()
{
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR)
    {
    }
    id_ = 0;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    {
        throw Failure(fmt::format("{} ended with {}: {}", name_,
                                  WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status),
                                  last_line(output_text())));
    }
}

void Program::wait_for(const std::string& text, std::chrono::seconds timeout) const
{
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (output_text().find(text) == std::string::npos)
    {
        if (std::chrono::steady_clock::now() > end)
        {
            throw Failure(
                fmt::format("{}: no '{}', but: {}", name_, text, last_line(output_text())));
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

std::string Program::ask(const std::string& line)
{
    const std::string sent = line + '\n';
    if (!line.empty() && ::send(talk_, sent.data(), sent.size(), MSG_NOSIGNAL) < 0)
    {
        throw Failure(fmt::format("{}: {}", name_, last_line(output_text())));
    }
    std::string answer;
    char letter = 0;
    while (::read(talk_, &letter, 1) == 1)
    {
        if (letter == '\n')
        {
            return answer;
        }
        answer += letter;
    }
    throw Failure(fmt::format("{}: {}", name_, last_line(output_text())));
}

std::string Program::output_text() const
{
    std::ifstream file(output_);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

} // namespace tactus::bench
