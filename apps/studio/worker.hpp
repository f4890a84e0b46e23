#pragma once

namespace maupertuis::studio {

/// A session behind a pipe: a line in is a request, or the word `cancel`; a line out is `message JSON` or `answer
/// JSON`. Ends with its input. Returns the exit code.
int work(int input, int output);

}  // namespace maupertuis::studio
