"""Arabic words (modern standard, unvocalised), with gender and agreement, and the eight who speak it.

Verbs are imperatives to a man, to which an object pronoun is joined as they are: -ه for what is masculine, -ها for what
is feminine. Adjectives follow their noun and agree with it in gender and definiteness.
"""

from .annotator import Annotator
from .facts import Place

SHAPES: dict[str, tuple[str, str]] = {
    "cube": ("مكعب", "m"),
    "cylinder": ("أسطوانة", "f"),
    "apple": ("تفاحة", "f"),
    "pear": ("كمثرى", "f"),
    "banana": ("موزة", "f"),
    "fork": ("شوكة", "f"),
    "spoon": ("ملعقة", "f"),
    "knife": ("سكين", "m"),
    "bowl": ("وعاء", "m"),
    "mug": ("كوب", "m"),
    "marker": ("قلم", "m"),
    "stapler": ("دباسة", "f"),
    "tape": ("شريط", "m"),
    "cup": ("كوب", "m"),
    "bottle": ("زجاجة", "f"),
    "can": ("علبة", "f"),
    "jar": ("مرطبان", "m"),
    "carton": ("كرتونة", "f"),
    "tub": ("وعاء", "m"),
}
"""Noun without article, and its gender."""
NOUNS: dict[str, tuple[str, str]] = {
    "قارورة": ("قارورة", "f"),
    "فنجان": ("فنجان", "m"),
    "زبدية": ("زبدية", "f"),
    "صندوق": ("صندوق", "m"),
    "برطمان": ("برطمان", "m"),
    "كأس": ("كأس", "f"),
}
"""Other nouns that some say."""
COLOURS: dict[str, tuple[str, str]] = {
    "red": ("أحمر", "حمراء"),
    "blue": ("أزرق", "زرقاء"),
    "yellow": ("أصفر", "صفراء"),
    "purple": ("بنفسجي", "بنفسجية"),
    "green": ("أخضر", "خضراء"),
    "orange": ("برتقالي", "برتقالية"),
    "brown": ("بني", "بنية"),
    "gray": ("رمادي", "رمادية"),
    "black": ("أسود", "سوداء"),
    "white": ("أبيض", "بيضاء"),
    "violet": ("أرجواني", "أرجوانية"),
}
"""Masculine and feminine."""
SIZES: dict[str, tuple[str, str]] = {"small": ("صغير", "صغيرة"), "large": ("كبير", "كبيرة")}
RELATIONS: dict[str, str] = {
    "left": "إلى يسار",
    "right": "إلى يمين",
    "front": "أمام",
    "behind": "خلف",
    "in": "في",
    "on": "فوق",
    "beside": "بجانب",
}
MOVING = ("انقل", "حرك")
"""Verbs that bring a thing to a part of the table, not into it;"""
PLACES = ("في الزاوية", "في الجهة", "في وسط", "في منتصف")
"""how parts of the table begin."""
ANYTHING = ("شيء", "m")


def at_place(place: Place, far: bool, middle: str) -> str:
    """Where a part of the table is, such as `في الزاوية العلوية اليسرى`; see `english.at_place`."""
    row = {"top": "البعيدة" if far else "العلوية", "bottom": "القريبة" if far else "السفلية", "middle": ""}[place[0]]
    column = {"left": "اليسرى", "right": "اليمنى", "middle": ""}[place[1]]
    if not row and not column:
        return f"في {middle} الطاولة"
    if row and column:
        return f"في الزاوية {row} {column}"
    return f"في الجهة {row or column} من الطاولة"


def joined(verb: str, gender: str) -> str:
    """A verb, or the preposition at its end, with an object pronoun joined to it."""
    pronoun = "ها" if gender == "f" else "ه"
    if verb.endswith(" على"):
        return f"{verb[:-1]}ي{pronoun}"
    return f"{verb}{pronoun}"


ANNOTATORS: tuple[Annotator, ...] = (
    Annotator(
        "ar_1",
        {
            "pick up": ("التقط",), "put down": ("ضع", "أنزل"), "move": ("انقل",),
            "grasp": ("أمسك",), "lift": ("ارفع",), "hold": ("احمل",), "lower": ("أنزل",),
            "drop": ("أسقط",), "press": ("اضغط على",), "push": ("ادفع",),
        },
        orders=("plain",),
        brief=0.05,
    ),
    Annotator(
        "ar_2",
        {
            "pick up": ("خذ", "التقط"), "put down": ("ضع",), "move": ("ضع", "انقل"),
            "grasp": ("امسك", "أمسك"), "lift": ("ارفع",), "hold": ("احمل",), "lower": ("أنزل",),
            "drop": ("أسقط",), "press": ("اضغط على",), "push": ("ادفع",),
        },
        nouns={"mug": "فنجان", "bottle": "قارورة"},
        relations={"on": "على", "in": "داخل", "left": "يسار", "right": "يمين"},
        orders=("plain", "two steps"),
        brief=0.4,
    ),
    Annotator(
        "ar_3",
        {
            "pick up": ("ارفع", "التقط"), "put down": ("ضع",), "move": ("حرك", "انقل"),
            "grasp": ("أمسك",), "lift": ("ارفع",), "hold": ("احمل",), "lower": ("أنزل",),
            "drop": ("اترك", "أسقط"), "press": ("اضغط على",), "push": ("ادفع", "حرك"),
        },
        relations={"behind": "وراء"},
        orders=("plain",),
        polite=("من فضلك", 0.6),
        located=0.2,
    ),
    Annotator(
        "ar_4",
        {
            "pick up": ("التقط", "أمسك"), "put down": ("أنزل", "ضع"), "move": ("انقل", "حرك"),
            "grasp": ("أمسك", "اقبض على"), "lift": ("ارفع",), "hold": ("احمل",), "lower": ("اخفض", "أنزل"),
            "drop": ("أسقط",), "press": ("اضغط على",), "push": ("ادفع",),
        },
        nouns={"jar": "برطمان"},
        relations={"in": "داخل", "beside": "قرب"},
        orders=("plain", "topic"),
        beside=0.3,
    ),
    Annotator(
        "ar_5",
        {
            "pick up": ("أمسك", "التقط"), "put down": ("ضع", "اترك"), "move": ("ضع", "انقل"),
            "grasp": ("أمسك",), "lift": ("ارفع",), "hold": ("احمل",), "lower": ("أنزل",),
            "drop": ("أسقط",), "press": ("اضغط على",), "push": ("ادفع",),
        },
        nouns={"carton": "صندوق"},
        colours={"purple": "violet"},
        orders=("plain", "destination first"),
        located=0.15,
    ),
    Annotator(
        "ar_6",
        {
            "pick up": ("التقط", "ارفع"), "put down": ("ضع", "أنزل"), "move": ("انقل",),
            "grasp": ("أمسك", "خذ"), "lift": ("ارفع",), "hold": ("احمل",), "lower": ("أنزل",),
            "drop": ("أسقط", "اترك"), "press": ("اضغط على",), "push": ("ادفع",),
        },
        orders=("two steps", "plain"),
        brief=0.3,
    ),
    Annotator(
        "ar_7",
        {
            "pick up": ("التقط",), "put down": ("ضع",), "move": ("انقل", "ضع"),
            "grasp": ("أمسك",), "lift": ("ارفع",), "hold": ("احمل",), "lower": ("أنزل",),
            "drop": ("أسقط",), "press": ("اضغط على",), "push": ("ادفع",),
        },
        orders=("plain",),
        polite=("رجاءً", 0.4),
        sized=0.5,
        brief=0.1,
    ),
    Annotator(
        "ar_8",
        {
            "pick up": ("خذ", "أمسك"), "put down": ("اترك", "ضع"), "move": ("حرك", "انقل"),
            "grasp": ("أمسك",), "lift": ("ارفع",), "hold": ("احمل",), "lower": ("أنزل",),
            "drop": ("أسقط",), "press": ("اضغط على",), "push": ("ادفع",),
        },
        nouns={"bowl": "زبدية", "cup": "كأس"},
        relations={"on": "على", "left": "على يسار", "right": "على يمين", "beside": "بجوار"},
        orders=("plain", "topic"),
        beside=0.2,
        wrong=0.07,
    ),
)  # fmt: skip
FAR = frozenset(("ar_3", "ar_6"))
"""Who says far and near for top and bottom."""
MIDDLE = {"ar_2": "منتصف", "ar_4": "منتصف", "ar_6": "منتصف", "ar_8": "منتصف"}
"""Who says منتصف for the centre."""
