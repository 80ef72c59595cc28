#pragma once

namespace cairn::app {

/// From here on a Ctrl-C (or SIGTERM) is only remembered; while one is, another kills.
void remember_interrupts();
bool interrupted();
/// What it asked for is under way: the next one is remembered anew.
void forget_interrupt();

}  // namespace cairn::app
