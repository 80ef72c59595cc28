#pragma once

namespace cairn::app {

/// From here on the first Ctrl-C (or SIGTERM) is only remembered; the second one kills.
void remember_interrupts();
bool interrupted();

}  // namespace cairn::app
