#include "umbrella.hpp"

umbrella::Answers umbrella::answers_elsewhere() { return answers(); }
