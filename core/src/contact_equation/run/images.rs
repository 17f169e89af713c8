//! Contacts that are in each other's place when an orbit has come back after a part of its period: found from gaps and rates at one phase, as
//! [`recurrence`](crate::branches::recurrence) tells orbits by their states at one.

use super::Run;
use crate::contact_equation::equations::pass_results::{GapExtreme, Image};
use crate::contact_equation::orbit::motion::Motion;
use crate::contact_equation::skeleton::placement::Switch;

/// Levels that differ by this part are one.
const SAME_LEVEL: f64 = 1e-9;
/// Where gaps are compared, in parts of the time after which the orbit comes back: nowhere in particular.
const LOOKED_AT: f64 = 0.377;

/// The image of a contact after so many parts.
pub(in crate::contact_equation) fn later(images: &[Image], contact: usize, parts: usize) -> Image {
    let own = Image { contact, sign: 1.0 };
    (0..parts).fold(own, |Image { contact, sign }, _| {
        let next = images[contact];
        Image {
            contact: next.contact,
            sign: sign * next.sign,
        }
    })
}

/// Whether levels are those of another contact, or the opposite ones.
fn are_alike(levels: &[f64], others: &[f64], sign: f64) -> bool {
    let same = |(level, other): (&f64, &f64)| {
        (level - sign * other).abs() <= SAME_LEVEL * level.abs().max(other.abs())
    };
    levels.len() == others.len()
        && if sign > 0.0 {
            levels.iter().zip(others).all(same)
        } else {
            levels.iter().zip(others.iter().rev()).all(same)
        }
}

impl Run<'_> {
    /// For every contact the one that has its gap, or the opposite, when the orbit has come back: found from the motion of the last pass.
    pub(in crate::contact_equation) fn images(&self) -> &[Image] {
        self.equations.images.get_or_init(|| self.seen_images())
    }

    /// A switch where the orbit has come back, as one of the contact whose gap does so there.
    pub(in crate::contact_equation) fn later(&self, switch: &Switch) -> Switch {
        let Image { contact, sign } = self.images()[switch.contact];
        if sign > 0.0 {
            return Switch { contact, ..*switch };
        }
        let levels = self.equations.values.contacts[contact].levels.len();
        Switch {
            contact,
            level: levels - 1 - switch.level,
            rises: !switch.rises,
            ..*switch
        }
    }

    /// The range of a gap over the period, from these extremes of what is followed.
    pub(in crate::contact_equation) fn range(
        &self,
        extremes: &[GapExtreme],
        contact: usize,
    ) -> f64 {
        let images = self.images();
        let parts = self.equations.skeleton.recurrence().parts;
        let all = extremes.iter().flat_map(|extreme| {
            let later = move |part| (later(images, extreme.contact, part), extreme.gap);
            (0..parts).map(later)
        });
        let own = all.filter(|(image, _)| image.contact == contact);
        let (low, high) = own.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), own| {
            let gap = own.0.sign * own.1;
            (low.min(gap), high.max(gap))
        });
        high - low
    }

    fn seen_images(&self) -> Vec<Image> {
        let skeleton = &self.equations.skeleton;
        let contacts = &self.equations.values.contacts;
        if skeleton.recurrence().parts == 1 {
            let own = |contact| Image { contact, sign: 1.0 };
            return (0..contacts.len()).map(own).collect();
        }
        let motion = Motion::of(&self.equations);
        let at = |phase: f64, state: &mut [f64]| motion.at(phase, state);
        let gaps = self.gaps(&at);
        let seen = |phase: f64| -> Vec<[f64; 2]> {
            let (state, all) = (gaps.state(phase), 0..contacts.len());
            let gap = |contact| gaps.gap_of(contact, phase, &state);
            all.map(gap).collect()
        };
        let phase = skeleton.begin + LOOKED_AT * skeleton.length;
        let [now, then] = [phase, phase + skeleton.length].map(seen);
        let base = self.equations.values.base;
        let mut taken = vec![false; contacts.len()];
        let mut images = Vec::with_capacity(contacts.len());
        for (contact, of) in contacts.iter().enumerate() {
            let apart = |other: usize, sign: f64| {
                let [gap, rate] = [0, 1].map(|i| (then[other][i] - sign * now[contact][i]).abs());
                gap + rate / base
            };
            let pairs = (0..contacts.len())
                .flat_map(|contact| [1.0, -1.0].map(|sign| Image { contact, sign }));
            let mut possible = pairs.filter(
                |Image {
                     contact: other,
                     sign,
                 }| {
                    !taken[*other] && are_alike(&of.levels, &contacts[*other].levels, *sign)
                },
            );
            let first = possible.next();
            let image = possible.fold(first, |best, next| {
                let distance = |image: &Image| apart(image.contact, image.sign);
                best.filter(|best| distance(best) <= distance(&next))
                    .or(Some(next))
            });
            let image = image.unwrap_or(Image { contact, sign: 1.0 });
            taken[image.contact] = true;
            images.push(image);
        }
        images
    }
}
