//! The opponent channels of Meyer (1988) and their two groups.

use std::fmt;
use std::ops::{Index, IndexMut};

use serde::{Deserialize, Serialize};

/// One axis of the opponent space of Meyer (1988).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Channel {
    /// Achromatic: luminance.
    A,
    /// Chromatic, red against green.
    C1,
    /// Chromatic, yellow against blue.
    C2,
}

impl Channel {
    /// All channels, in the order of the rows of Eq. 2.
    pub const ALL: [Self; 3] = [Self::A, Self::C1, Self::C2];

    /// The group that is varied together with this channel.
    pub const fn group(self) -> ChannelGroup {
        match self {
            Self::A => ChannelGroup::Achromatic,
            Self::C1 | Self::C2 => ChannelGroup::Chromatic,
        }
    }
}

impl fmt::Display for Channel {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::A => "A",
            Self::C1 => "C1",
            Self::C2 => "C2",
        })
    }
}

/// The channels that one sequence of the study varies together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ChannelGroup {
    /// A alone.
    Achromatic,
    /// C1 and C2.
    Chromatic,
}

impl ChannelGroup {
    /// Both groups, in the order of the paper's figures 8 and 9.
    pub const ALL: [Self; 2] = [Self::Achromatic, Self::Chromatic];

    /// The name used as the level of the factor `channel`.
    pub const fn level(self) -> &'static str {
        match self {
            Self::Achromatic => "achromatic",
            Self::Chromatic => "chromatic",
        }
    }
}

impl fmt::Display for ChannelGroup {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.level())
    }
}

/// One value for each channel; no table can be short of a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PerChannel<T> {
    /// The value of the achromatic channel.
    pub a: T,
    /// The value of the red–green channel.
    pub c1: T,
    /// The value of the yellow–blue channel.
    pub c2: T,
}

impl<T> PerChannel<T> {
    /// Asks `value` for each channel in turn: A, C1, C2.
    pub fn from_fn(mut value: impl FnMut(Channel) -> T) -> Self {
        Self {
            a: value(Channel::A),
            c1: value(Channel::C1),
            c2: value(Channel::C2),
        }
    }
}

impl<T> Index<Channel> for PerChannel<T> {
    type Output = T;

    fn index(&self, channel: Channel) -> &T {
        match channel {
            Channel::A => &self.a,
            Channel::C1 => &self.c1,
            Channel::C2 => &self.c2,
        }
    }
}

impl<T> IndexMut<Channel> for PerChannel<T> {
    fn index_mut(&mut self, channel: Channel) -> &mut T {
        match channel {
            Channel::A => &mut self.a,
            Channel::C1 => &mut self.c1,
            Channel::C2 => &mut self.c2,
        }
    }
}
