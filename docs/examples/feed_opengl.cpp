// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/* feed_opengl [PORT]: moves a scene in OpenGL by the datagrams of spm_view --feed-udp PORT. */
#include <algorithm>
#include <arpa/inet.h>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sys/socket.h>
#ifdef WITH_GLFW
#include <GLFW/glfw3.h>
#endif

#include "tactus_feed.h"

int main(int argc, char** argv)
{
    const int feed_socket = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0);
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_port = htons(static_cast<uint16_t>(argc > 1 ? atoi(argv[1]) : 7301));
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (bind(feed_socket, reinterpret_cast<sockaddr*>(&here), sizeof(here)) != 0)
        return std::perror("bind"), 2;
    static tactus_feed feed;                      // The newest datagram.
    std::map<uint32_t, tactus_feed_object> scene; // Objects by their numbers, of all parts.
    const auto receive = [&]
    {
        char bytes[TACTUS_FEED_BYTES_MAX + 1];
        for (ssize_t size; (size = recv(feed_socket, bytes, sizeof(bytes), 0)) >= 0;)
            if (const char* why = tactus_feed_read(&feed, bytes, size))
                std::fprintf(stderr, "feed: %s\n", why);
            else
            {
                if (feed.head.part == 0) // A new state; removed objects are not in it.
                    scene.clear();
                for (int i = 0; i < feed.head.object_count; ++i)
                    scene[feed.objects[i].number] = feed.objects[i];
            }
    };
#ifdef WITH_GLFW
    GLFWwindow* window =
        glfwInit() ? glfwCreateWindow(800, 800, "feed", nullptr, nullptr) : nullptr;
    if (window == nullptr)
        return std::fprintf(stderr, "feed: no window\n"), 2;
    glfwMakeContextCurrent(window);
    const auto draw = [](const double* at, const double* q, double size) { // q is x, y, z, w.
        glLoadIdentity();
        glTranslated(at[0], at[1], at[2]);
        glRotated(std::acos(std::clamp(q[3], -1.0, 1.0)) * 360 / M_PI, q[0], q[1], q[2]);
        glScaled(size, size, size);
        glBegin(GL_LINES); // Draw your mesh here; these are the axes of its frame.
        for (int axis = 0; axis < 3; ++axis)
            for (int end = 0; end < 2; ++end)
                glColor3d(axis == 0, axis == 1, axis == 2),
                    glVertex3d(end * (axis == 0), end * (axis == 1), end * (axis == 2));
        glEnd();
    };
    for (; !glfwWindowShouldClose(window); glfwSwapBuffers(window), glfwPollEvents())
    {
        receive();
        glClear(GL_COLOR_BUFFER_BIT);
        glMatrixMode(GL_PROJECTION), glLoadIdentity(), glOrtho(-.1, .1, -.1, .1, -1, 1);
        glMatrixMode(GL_MODELVIEW);
        for (const auto& [number, object] : scene)
            draw(object.translation_m, object.rotation, 0.03 * object.scale);
        for (int i = 0; i < feed.head.tool_count; ++i)
            draw(feed.tools[i].proxy_m, feed.tools[i].proxy_rotation, 0.01);
    }
    glfwTerminate();
#else // The receiver alone: prints the first state with objects.
    while (scene.empty())
        receive();
    for (int i = 0; i < feed.head.tool_count; ++i)
        std::printf("tool %d: proxy at %.4f %.4f %.4f m, force %.3f %.3f %.3f N\n", i,
                    feed.tools[i].proxy_m[0], feed.tools[i].proxy_m[1], feed.tools[i].proxy_m[2],
                    feed.tools[i].force_n[0], feed.tools[i].force_n[1], feed.tools[i].force_n[2]);
    std::printf("%zu objects\n", scene.size());
#endif
}
