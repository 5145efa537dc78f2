// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/feed.hpp"
#include "host_tools/spm_view/film.hpp"
#include "host_tools/spm_view/live_state.hpp"
#include "host_tools/spm_view/model_fetcher.hpp"
#include "host_tools/spm_view/model_shelf.hpp"
#include "host_tools/spm_view/options.hpp"
#include "host_tools/spm_view/web_server.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "transport/base/program_log.hpp"
#include "transport/dds/telemetry.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

namespace tactus::view
{

namespace
{

/// Interval of the polls for DDS data; the second value applies while data of models are in
/// transit.
constexpr std::chrono::milliseconds kLook{5};
constexpr std::chrono::milliseconds kBusyLook{1};

/// End of serving: at a stop request, or after --seconds since the start.
class Stay
{
public:
    explicit Stay(const std::optional<double>& seconds) : seconds_(seconds) {}

    [[nodiscard]] bool is_over() const
    {
        const double passed_s = std::chrono::duration<double>(Clock::now() - start_).count();
        return is_stop_requested() || (seconds_ && passed_s >= *seconds_);
    }

private:
    using Clock = std::chrono::steady_clock;
    std::optional<double> seconds_;
    Clock::time_point start_{Clock::now()};
};

/// Readers of DDS data.
struct Ears
{
    std::unique_ptr<dds::TelemetryReader> telemetry;
    std::unique_ptr<ModelFetcher> models; ///< Null if this program may not request pieces.
    std::optional<FeedSender> feed;       ///< None without --feed-udp.
};

/// Requests the models of the refinement state and of the objects in the newest sample.
void look_for_models(ModelFetcher& models, const dds::WatchedController& controller)
{
    for (const RefinementStateModel& model : controller.state->state.models)
    {
        models.look_for(model.hash);
    }
    for (const ObjectTelemetry& object : controller.objects.objects)
    {
        models.look_for(object.model);
    }
}

void look(Ears& ears, LiveState& live)
{
    ears.telemetry->poll();
    live.publish(ears.telemetry->controllers());
    for (const dds::WatchedController& controller : ears.telemetry->controllers())
    {
        if (ears.models != nullptr && controller.state != nullptr)
        {
            look_for_models(*ears.models, controller);
        }
    }
    if (ears.feed)
    {
        ears.feed->send(*live.newest());
    }
}

void watch(Ears& ears, LiveState& live, const Stay& stay)
{
    using Clock = std::chrono::steady_clock;
    auto looked = Clock::now() - kLook;
    while (!stay.is_over())
    {
        if (const auto now = Clock::now(); now - looked >= kLook)
        {
            looked = now;
            look(ears, live);
        }
        bool is_busy = false;
        if (ears.models != nullptr)
        {
            ears.models->step();
            is_busy = ears.models->is_busy();
        }
        std::this_thread::sleep_for(is_busy ? kBusyLook : kLook);
    }
}

Result<Ears, Refusal> listen(const dds::Domain& domain, ModelShelf& shelf)
{
    auto telemetry = dds::TelemetryReader::create(domain, true);
    auto models = ModelFetcher::create(domain, shelf,
                                       [](const std::string& text)
                                       { log_message(LogLevel::warning, "spm_view", text); });
    if (!telemetry)
    {
        return telemetry.error();
    }
    Ears ears{std::move(telemetry).value(), nullptr, std::nullopt};
    if (models)
    {
        ears.models = std::move(models).value();
    }
    else // DDS Security may allow a participant to receive but not to request.
    {
        log_message(LogLevel::warning, "spm_view",
                    fmt::format("only models from files can be shown: {}", models.error().text));
    }
    return ears;
}

/// Starts the web server and prints its address; `what` describes the content of the page.
Result<std::unique_ptr<WebServer>, Refusal> serve(const WebServer::Parts& parts,
                                                  const Options& options, const std::string& what)
{
    auto server = WebServer::start(parts, static_cast<std::uint16_t>(options.port));
    if (server)
    {
        log_message(LogLevel::info, "spm_view",
                    fmt::format("http://127.0.0.1:{}/ shows {}; end with Ctrl-C",
                                server.value()->port(), what));
    }
    return server;
}

int show_live(const CommandLine& line, const Options& options, ModelShelf& shelf)
{
    const auto domain = dds::Domain::join({options.domain, options.security}, dds::Party::both);
    if (!domain)
    {
        return line.fail(domain.error().text);
    }
    auto ears = listen(domain.value(), shelf);
    if (!ears)
    {
        return line.fail(ears.error().text);
    }
    if (options.feed_udp)
    {
        auto feed = FeedSender::open({options.feed_udp->address, options.feed_udp->port});
        if (!feed)
        {
            return line.fail(feed.error().text);
        }
        ears.value().feed.emplace(std::move(feed).value());
    }
    LiveState live;
    const auto server =
        serve({live, shelf, options.domain, TACTUS_JAVASCRIPT_DIR, nullptr, options.pages}, options,
              fmt::format("DDS domain {}", options.domain));
    if (!server)
    {
        return line.fail(server.error().text);
    }
    watch(ears.value(), live, Stay(options.seconds));
    return kExitDone;
}

int show_recordings(const CommandLine& line, const Options& options, ModelShelf& shelf)
{
    std::vector<std::unique_ptr<Film>> developed;
    for (const std::string& path : options.recordings)
    {
        auto film = Film::develop(path, static_cast<std::uint8_t>(developed.size() + 1), shelf,
                                  [] { return !is_stop_requested(); });
        if (!film)
        {
            return line.fail(film.error().text);
        }
        developed.push_back(std::move(film).value());
    }
    const Films films(std::move(developed));
    const LiveState live;
    const auto server =
        serve({live, shelf, options.domain, TACTUS_JAVASCRIPT_DIR, &films, options.pages}, options,
              fmt::format("{} frames of {}", films.frames(),
                          options.recordings.size() == 1 ? options.recordings.front()
                                                         : "two recordings"));
    if (!server)
    {
        return line.fail(server.error().text);
    }
    for (const Stay stay(options.seconds); !stay.is_over();)
    {
        std::this_thread::sleep_for(kLook);
    }
    return kExitDone;
}

int run(int argc, char** argv)
{
    CommandLine line("spm_view", "Shows the contacts of controllers in a browser on this machine, "
                                 "with the reasons for withheld forces.");
    const auto parsed = parse_options(line, argc, argv);
    if (const int* code = std::get_if<int>(&parsed))
    {
        return *code;
    }
    const auto& options = std::get<Options>(parsed);
    const auto shelf = ModelShelf::open(options.files);
    if (!shelf)
    {
        return line.fail(shelf.error().text);
    }
    stop_on_signals();
    return options.recordings.empty() ? show_live(line, options, *shelf.value())
                                      : show_recordings(line, options, *shelf.value());
}

} // namespace

} // namespace tactus::view

int main(int argc, char** argv)
{
    return tactus::run_program("spm_view", "", [&] { return tactus::view::run(argc, argv); });
}
